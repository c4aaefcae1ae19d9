"""Campaigns and diagnoses on a cluster of processes that are killed, on disks that fill, with files that are damaged."""

from __future__ import annotations

import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import full_disk
import pytest
import rins
import rins.distributed
from conftest import SHORT
from distributed import Client, LocalCluster, WorkerPlugin

RUNS = 704
SHARDS = 11
"""Of one portion of 64 runs each."""


class Import(WorkerPlugin):
    """Imports `full_disk` in a worker, also in one that is restarted."""

    def setup(self, worker: object) -> None:
        assert full_disk.FullDisk.protocol == "full"


@pytest.fixture(scope="module")
def cluster() -> Iterator[LocalCluster]:
    start: Any = LocalCluster
    with start(
        n_workers=4, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def client(cluster: LocalCluster) -> Iterator[Client]:
    connect: Any = Client
    with connect(cluster) as client:
        client.register_plugin(Import())
        yield client


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scenario whose line ends are those of Windows: workers get the bytes."""
    path = tmp_path_factory.mktemp("scenario") / "short.toml"
    path.write_bytes(SHORT.replace("\n", "\r\n").encode())
    return path


@pytest.fixture(scope="module")
def expected(scenario: Path) -> str:
    """The SHA-256 of the campaign in one process."""
    output = scenario.with_name("single.parquet")
    rins.monte_carlo(scenario, RUNS, output, seed=7)
    return sha256(output)


class Killer:
    """Kills a worker at random each time that another three shards are in `store`, however fast the machine is."""

    def __init__(self, cluster: LocalCluster, store: Path) -> None:
        self.cluster, self.store = cluster, store
        self.kills = 0
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self._run)

    def __enter__(self) -> Killer:
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.ended.set()
        self.thread.join()

    def _run(self) -> None:
        draw = random.Random(1)
        while not self.ended.wait(0.01):
            nannies: list[Any] = list(self.cluster.workers.values())
            pids = [nanny.pid for nanny in nannies if nanny.pid]
            if pids and len(list(self.store.glob("part-*.record"))) >= 1 + 3 * self.kills:
                os.kill(draw.choice(pids), signal.SIGKILL)
                self.kills += 1


@pytest.fixture(scope="module")
def finished(
    cluster: LocalCluster, client: Client, scenario: Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, int]:
    """The store of a campaign whose workers were killed, and the number of kills."""
    store = tmp_path_factory.mktemp("store") / "campaign"
    with Killer(cluster, store) as killer:
        result = rins.distributed.monte_carlo(
            client, scenario, RUNS, store=store, shards=SHARDS, seed=7
        )
    assert result["runs"] == RUNS and result["shard"] == [1, 1]
    return store, killer.kills


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def times(store: Path) -> dict[str, int]:
    """When each shard was written."""
    return {path.name: path.stat().st_mtime_ns for path in store.glob("part-*") if path.suffix != ".record"}


def test_killed_workers_do_not_change_the_campaign(
    finished: tuple[Path, int], expected: str
) -> None:
    store, kills = finished
    assert kills >= 3
    assert sha256(store / "campaign.parquet") == expected
    assert (store / "campaign.html").exists()
    # Nothing is left of what the dead workers were writing.
    parts = {f"part-{shard:02}.parquet" for shard in range(1, SHARDS + 1)}
    records = {f"{part}.record" for part in parts}
    others = {"campaign.json", "campaign.parquet", "campaign.html"}
    assert {path.name for path in store.iterdir()} == parts | records | others


def test_damaged_shards_are_computed_again_and_no_others(
    client: Client, scenario: Path, finished: tuple[Path, int], expected: str, tmp_path: Path
) -> None:
    store = tmp_path / "store"
    shutil.copytree(finished[0], store)
    before = times(store)
    cut, altered, unrecorded, foreign = (f"part-{shard:02}.parquet" for shard in (3, 5, 8, 10))
    content = (store / cut).read_bytes()
    (store / cut).write_bytes(content[: len(content) // 2])
    content = (store / altered).read_bytes()
    (store / altered).write_bytes(content[:99] + bytes([content[99] ^ 1]) + content[100:])
    (store / f"{unrecorded}.record").unlink()
    # A whole shard of the same campaign in the place of another one.
    for suffix in ("", ".record"):
        shutil.copy(store / f"part-09.parquet{suffix}", store / f"{foreign}{suffix}")
    damaged = times(store)
    (store / "campaign.parquet").unlink()

    reports: list[tuple[str, int | None, int | None]] = []
    call: dict[str, Any] = {"seed": 7, "progress": lambda *report: reports.append(report)}
    rins.distributed.monte_carlo(client, scenario, RUNS, store=store, **call)
    after = times(store)
    changed = {name for name, time in after.items() if time != damaged[name]}
    assert changed == {cut, altered, unrecorded, foreign}
    assert {name: after[name] for name in after if name not in changed} == {
        name: before[name] for name in before if name not in changed
    }
    assert sha256(store / "campaign.parquet") == expected
    assert reports[0] == ("running shards", 0, SHARDS)
    assert reports[-1] == ("running shards", SHARDS, SHARDS)


def test_full_disk_is_tried_again(
    client: Client, scenario: Path, expected: str, tmp_path: Path
) -> None:
    (tmp_path / "counter").mkdir()
    (tmp_path / "store").mkdir()
    options = {"counter": str(tmp_path / "counter"), "times": 2}
    call: dict[str, Any] = {"shards": 4, "seed": 7, "storage_options": options}
    url = f"full://{tmp_path}/store"
    with pytest.raises(ValueError, match="output: missing"):
        rins.distributed.monte_carlo(client, scenario, RUNS, store=url, **call)
    output = tmp_path / "merged.parquet"
    rins.distributed.monte_carlo(client, scenario, RUNS, store=url, output=output, **call)
    assert len(list((tmp_path / "counter").iterdir())) == 2
    assert sha256(output) == expected
    assert not list((tmp_path / "store").glob(".*"))
    with pytest.raises(rins.DataError, match="exists already"):
        rins.distributed.monte_carlo(client, scenario, RUNS, store=url, output=output, **call)


def test_disk_that_stays_full_is_an_error(client: Client, scenario: Path, tmp_path: Path) -> None:
    (tmp_path / "counter").mkdir()
    (tmp_path / "store").mkdir()
    with pytest.raises(rins.distributed.DistributedError) as caught:
        rins.distributed.monte_carlo(
            client,
            scenario,
            128,
            store=f"full://{tmp_path}/store",
            shards=2,
            output=tmp_path / "merged.parquet",
            retries=1,
            storage_options={"counter": str(tmp_path / "counter"), "times": 10**6},
        )
    assert re.search(r"shard [12] of 2: failed 2 times, .*No space left", str(caught.value))
    assert isinstance(caught.value.__cause__, OSError)
    assert not list((tmp_path / "store").glob("part-*"))


def test_more_shards_than_portions_give_the_same_bytes(
    client: Client, scenario: Path, tmp_path: Path
) -> None:
    rins.monte_carlo(scenario, 70, tmp_path / "single.parquet")
    rins.distributed.monte_carlo(client, scenario, 70, store=tmp_path / "store", shards=5)
    assert sha256(tmp_path / "store/campaign.parquet") == sha256(tmp_path / "single.parquet")


MODEL = """
schema = 1
base = "paper12"

[[term]]
id = "gyro.scale"
estimate = ["x", "z"]
sigma = { x = "1 ppm" }
"""


def test_campaign_of_a_model_file_is_that_of_one_process(
    client: Client, scenario: Path, tmp_path: Path
) -> None:
    model = tmp_path / "model.toml"
    model.write_text(MODEL, encoding="utf-8")
    for name, choice in (("full", "full"), ("file", model)):
        options: dict[str, Any] = {"seed": 3, "model": choice, "noise": "given", "truth": "scenario"}
        single = tmp_path / f"{name}.parquet"
        rins.monte_carlo(scenario, 6, single, **options)
        store = tmp_path / name
        rins.distributed.monte_carlo(client, scenario, 6, store=store, shards=3, **options)
        assert sha256(store / "campaign.parquet") == sha256(single), name
        # The store belongs to this model.
        with pytest.raises(rins.DataError, match="model: the store holds a campaign with"):
            rins.distributed.monte_carlo(client, scenario, 6, store=store, seed=3)
    model.write_text(MODEL.replace("1 ppm", "1 m"), encoding="utf-8")
    with pytest.raises(rins.ModelError) as caught:
        rins.distributed.monte_carlo(client, scenario, 6, store=tmp_path / "bad", model=model)
    assert caught.value.file == str(model) and caught.value.line == 8
    assert not (tmp_path / "bad").exists()


def test_blind_trials_in_shards_are_those_of_one_shard(client: Client, tmp_path: Path) -> None:
    def found(journal: Path) -> list[dict[str, Any]]:
        with open(journal, encoding="utf-8") as lines:
            return [json.loads(without_time(line)) for line in lines]

    call: dict[str, Any] = {"seed": 5, "population": "null"}
    one = rins.distributed.blind(client, 4, store=tmp_path / "one", shards=1, **call)
    several = rins.distributed.blind(client, 4, store=tmp_path / "several", shards=4, **call)
    assert one.journal == tmp_path / "one/trials.jsonl" and len(one.records()) == 4
    assert found(one.journal) == found(several.journal)
    assert one.page.splitlines()[0] == several.page.splitlines()[0]
    assert "4 runs" in several.page and "0 ended without an answer" in several.page
    # All shards are there: nothing is run again.
    before = times(tmp_path / "several")
    rins.distributed.blind(client, 4, store=tmp_path / "several", **call)
    assert times(tmp_path / "several") == before
    with pytest.raises(rins.DataError, match="seed: the store holds a campaign with 5"):
        rins.distributed.blind(client, 4, store=tmp_path / "several", seed=6, population="null")
    with pytest.raises(ValueError, match="population: 'all'"):
        rins.distributed.blind(client, 4, store=tmp_path / "no", population="all")


def test_wrong_arguments_are_refused_before_the_campaign(
    client: Client, scenario: Path, finished: tuple[Path, int], tmp_path: Path
) -> None:
    campaign = rins.distributed.monte_carlo
    store = tmp_path / "store"
    for wrong in ({"shards": 0}, {"runs": 0}, {"retries": -1}, {"threads": 0}, {"in_flight": 0}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            campaign(client, scenario, **{"runs": 10, "store": store, **wrong})  # type: ignore[arg-type]
    with pytest.raises(rins.DataError, match="cannot read") as absent:
        campaign(client, tmp_path / "no.toml", 10, store=store)
    assert absent.value.file == str(tmp_path / "no.toml")
    bad = tmp_path / "bad.toml"
    bad.write_text(SHORT.replace('"50 Hz"', '"50 m"'), encoding="utf-8")
    with pytest.raises(rins.DataError) as caught:
        campaign(client, bad, 10, store=store)
    assert (caught.value.file, caught.value.key) == ("bad.toml", "[log] rate")
    assert caught.value.line == SHORT[: SHORT.index('"50 Hz"')].count("\n") + 1
    assert not store.exists()
    # A folder cannot be made within a file.
    with pytest.raises(rins.DataError, match="the store cannot be used"):
        campaign(client, scenario, 10, store=bad / "store")
    with pytest.raises(rins.DataError, match="seed: the store holds a campaign with 7"):
        campaign(client, scenario, RUNS, store=finished[0], seed=8)
    with pytest.raises(rins.DataError, match="no such folder"):
        campaign(client, scenario, 10, store=store, output=tmp_path / "no" / "merged.parquet")


def test_worker_that_does_not_reach_the_store_says_so(
    client: Client, scenario: Path, tmp_path: Path
) -> None:
    # Each process has a memory of its own.
    with pytest.raises(rins.distributed.DistributedError, match="the worker does not find it"):
        rins.distributed.monte_carlo(
            client,
            scenario,
            64,
            store="memory://campaign",
            output=tmp_path / "merged.parquet",
            retries=0,
        )


def test_scheduler_knows_few_tasks_at_a_time(client: Any) -> None:
    from rins._tasks import Task, run_all

    known: list[int] = []
    ended: list[int] = []

    def done(task: Task) -> None:
        ended.append(task.number)
        if task.number % 50 == 0:
            known.append(scheduler_tasks(client))

    tasks = (Task(number, str(number), abs, (number,)) for number in range(600))
    run_all(client, tasks, name="few", retries=0, deaths=0, in_flight=8, done=done, failed=fail)
    assert sorted(ended) == list(range(600))
    # Of 600, as many as are in flight, and those whose release is on its way.
    assert len(known) == 12 and max(known) <= 16
    groups = client.run_on_scheduler(lambda dask_scheduler: list(dask_scheduler.task_groups))
    assert sum("few" in group for group in groups) <= 1


def fail(task: object, error: BaseException, what: str) -> None:
    raise error


def die_of_it(folder: str, times: int) -> None:
    """Kill this worker, unless the task has killed so many."""
    for number in range(times):
        try:
            os.close(os.open(f"{folder}/{number}", os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            continue
        os.kill(os.getpid(), signal.SIGKILL)


def test_task_that_kills_its_workers_ends(client: Client, tmp_path: Path) -> None:
    from rins._tasks import Task, run_all

    ended: list[str] = []
    for name, times in (("some", 5), ("all", 100)):
        (tmp_path / name).mkdir()
        run_all(
            client,
            iter([Task(1, name, die_of_it, (str(tmp_path / name), times))]),
            name="die",
            retries=0,
            deaths=4,
            in_flight=None,
            done=lambda task: ended.append(f"{task.label}: done"),
            failed=lambda task, error, what: ended.append(f"{task.label}: {what}"),
        )
    # The scheduler gives up after 4 deaths. The first task is submitted again and ends, the second is given up after 8.
    assert ended == ["some: done", "all: 8 workers died while they had it"]
    assert len(list((tmp_path / "some").iterdir())) == 5
    assert len(list((tmp_path / "all").iterdir())) == 8


def scheduler_tasks(client: Any) -> int:
    def count(dask_scheduler: Any) -> int:
        return sum("few" in str(key) for key in dask_scheduler.tasks)

    number: int = client.run_on_scheduler(count)
    return number


def without_time(text: str) -> str:
    return re.sub(r'"seconds":[0-9.e-]+', '"seconds":0', text)


def test_many_rigs_are_diagnosed_and_failures_are_results(
    client: Client, short: Path, tmp_path: Path
) -> None:
    rigs = tmp_path / "rigs"
    text = short.read_text(encoding="utf-8")
    assert text.count('path = "run.csv"') == 1 and text.count('latitude = "') == 1
    for name in ("good", "elsewhere", "bad", "lost"):
        (rigs / name).mkdir(parents=True)
        (rigs / name / "rig.toml").write_text(text, encoding="utf-8")
    shutil.copy(short.with_name("run.csv"), rigs / "good")
    # A log that is not below the folder of its rig file.
    (rigs / "logs").mkdir()
    shutil.copy(short.with_name("run.csv"), rigs / "logs" / "run.csv")
    (rigs / "elsewhere" / "rig.toml").write_text(
        text.replace('"run.csv"', '"../logs/run.csv"'), encoding="utf-8"
    )
    shutil.copy(short.with_name("run.csv"), rigs / "bad")
    bad = re.sub('latitude = "[^"]*"', 'latitude = "45 m"', text)
    (rigs / "bad" / "rig.toml").write_text(bad, encoding="utf-8")
    paths = [rigs / name / "rig.toml" for name in ("good", "bad", "elsewhere", "lost")]
    store = tmp_path / "store"

    good, failed, elsewhere, lost = rins.distributed.diagnose_many(client, paths, store=store)
    alone = rins.diagnose(paths[2])
    assert without_time(elsewhere.to_json()) == without_time(alone.to_json())
    assert elsewhere.rig == str(paths[2]) and elsewhere.error is None
    assert good.verdict == elsewhere.verdict == alone.verdict
    assert str(rigs / "good" / "run.csv") in good.to_json()
    with pytest.raises(rins.DataError) as caught:
        rins.diagnose(paths[1])
    error = failed.error
    assert isinstance(error, rins.DataError) and str(error) == str(caught.value)
    assert (error.file, error.key) == (str(paths[1]), "[site] latitude")
    assert error.line == caught.value.line and error.line is not None
    with pytest.raises(rins.DataError, match="latitude"):
        failed.to_json()
    assert lost.error is not None and lost.error.file == str(rigs / "lost" / "run.csv")
    assert not (store / "inputs").exists() and not list(store.glob(".*"))

    # The workers read the paths themselves; a log that changed is diagnosed again, another one is not.
    kept, changed = Path(good.file), Path(elsewhere.file)
    before = (kept.stat().st_mtime_ns, changed.stat().st_mtime_ns)
    log = rigs / "logs" / "run.csv"
    rows = log.read_text(encoding="utf-8").splitlines()
    log.write_text("\n".join(rows[:4000]) + "\n", encoding="utf-8")
    again = rins.distributed.diagnose_many(client, paths, store=store, upload=False)
    assert kept.stat().st_mtime_ns == before[0] and changed.stat().st_mtime_ns != before[1]
    assert without_time(again[2].to_json()) != without_time(alone.to_json())
    assert again[1].error is not None and again[1].error.line == error.line
    assert again[3].error is not None and again[3].error.file == lost.error.file
    urls = [f"local://{rigs}/{name}/rig.toml" for name in ("bad", "lost", "none")]
    reached = [one.error for one in rins.distributed.diagnose_many(client, urls, store=store)]
    assert [one is not None and one.file for one in reached] == [
        urls[0],
        f"file://{rigs}/lost/run.csv",
        f"file://{rigs}/none/rig.toml",
    ]
    assert reached[0] is not None and (reached[0].line, reached[0].key) == (error.line, error.key)
    # A result that was altered is not kept.
    data = json.loads(kept.read_text(encoding="utf-8"))
    kept.write_text(json.dumps({**data, "verdict": "named"}), encoding="utf-8")
    restored = rins.distributed.diagnose_many(client, paths[:1], store=store)
    assert without_time(restored[0].to_json()) == without_time(good.to_json())
    with pytest.raises(ValueError, match="twice"):
        rins.distributed.diagnose_many(client, [paths[0], paths[0]], store=store)


def test_rins_does_not_import_dask() -> None:
    code = (
        "import rins, sys; assert not {'dask', 'distributed', 'fsspec'} & set(sys.modules);"
        "import rins.distributed; assert not {'dask', 'distributed', 'fsspec'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
