"""Campaigns and diagnoses on a Dask cluster (`dask.distributed`): ``pip install 'rins[dask]'``.

| function | result |
| --- | --- |
| `monte_carlo` | a Monte Carlo campaign in shards, merged: the bytes of `rins.monte_carlo` |
| `diagnose_many` | one diagnosis for each rig |
| `blind` | blind trials of the diagnosis in shards, and their figures |

Each task puts one file into a store: a folder that all workers reach, or a URL that fsspec opens, such as ``s3://bucket/campaign``.
Results do not pass through the scheduler. A task is idempotent; a call that is repeated continues with what the store holds. A file
counts as complete if its SHA-256 is the recorded one.

>>> from distributed import Client  # doctest: +SKIP
>>> import rins.distributed  # doctest: +SKIP
>>> client = Client("scheduler:8786")  # doctest: +SKIP
>>> res = rins.distributed.monte_carlo(client, "scenario.toml", 10_000_000, store="s3://bucket/c1")  # doctest: +SKIP
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _rins
from ._commands import merge
from ._errors import DataError
from ._progress import Report, listener
from ._rigs import Diagnosis, Diagnoses, Options
from ._shards import (
    RUNS_OF_A_SHARD,
    TRIALS_OF_A_SHARD,
    Campaign,
    ModelOption,
    Shards,
    Trials,
    usual_shards,
)
from ._store import Store
from ._tasks import DistributedError, Task, ensure_synchronous, run_all, threads_of

if TYPE_CHECKING:
    from distributed import Client

    from . import schema
    from ._result import Result

__all__ = ["BlindTrials", "Diagnosis", "DistributedError", "blind", "diagnose_many", "monte_carlo"]

_MERGED = "campaign.parquet"
_JOURNAL = "trials.jsonl"


def monte_carlo(
    client: Client,
    scenario: str | PathLike[str],
    runs: int,
    *,
    store: str | PathLike[str],
    shards: int | None = None,
    seed: int | None = None,
    model: str | PathLike[str] = "paper12",
    noise: str = "likely",
    truth: str = "prior",
    output: str | PathLike[str] | None = None,
    force: bool = False,
    retries: int = 5,
    deaths: int = 100,
    threads: int = 1,
    in_flight: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    progress: bool | Report = False,
) -> Result[schema.CampaignResult]:
    """Run a Monte Carlo campaign in shards on the workers of a cluster, and merge them.

    Parameters
    ----------
    client : distributed.Client
        The client of the cluster.
    scenario : path-like
        The scenario file; it may define a parameter grid. Workers get its content.
    runs : int
        The number of runs of each scenario.
    store : path-like or str
        Where the shards are kept: a folder that the client and all workers reach, or a URL of fsspec.
    shards : int, optional
        The number of shards; by default that of the campaign in the store, otherwise four a thread, with at most 10,000 runs each.
    seed : int, optional
        The seed; by default the scenario's.
    model, noise, truth
        As of `rins.monte_carlo`. Workers get the content of a model file.
    output : path-like, optional
        The file of the merged results on the machine of the client; the report page lies beside it. By default ``campaign.parquet``
        in a store that is a folder.
    force : bool
        Whether an existing `output` is replaced. By default that in the store is.
    retries : int
        How often a shard is repeated after an error.
    deaths : int
        How many workers may die while they have a shard. Most do not die of it.
    threads : int
        The number of threads of a shard. A worker runs as many shards at a time as it has threads of its own.
    in_flight : int, optional
        The most shards that the scheduler knows at a time; by default twice the number of threads of the cluster.
    storage_options : mapping, optional
        The arguments of fsspec's file system, such as credentials.
    progress : bool or callable
        As of `rins.calibrate`; it counts shards.

    Returns
    -------
    Result
        As of `rins.merge`. The Parquet file has the bytes of one that `rins.monte_carlo` writes.

    Raises
    ------
    DataError
        If the scenario is invalid, the store cannot be used or holds another campaign, or the output exists.
    DistributedError
        If a shard failed more often than `retries` and `deaths` permit; the cause is its last exception. The other shards stay in
        the store.
    """
    ensure_synchronous(client)
    _ensure_numbers({"runs": runs, "threads": threads}, 1)
    _ensure_numbers({"retries": retries, "deaths": deaths}, 0)
    _ensure_numbers({"shards": shards, "in_flight": in_flight}, 1)
    place = Store.at(store, storage_options)
    if shards is None:
        shards = usual_shards(place, runs, threads_of(client), RUNS_OF_A_SHARD)
    path = Path(scenario)
    campaign = Campaign(
        shards=shards,
        threads=threads,
        store=place,
        name=path.name,
        scenario=_read(path),
        runs=runs,
        seed=seed,
        model=_model_option(model),
        noise=noise,
        truth=truth,
    )
    merged, force = _output(place, output, _MERGED, force)
    campaign.check()
    _run_shards(client, campaign, "monte-carlo", (retries, deaths, in_flight), progress)
    with campaign.collected(merged.parent) as parts:
        return merge(parts, merged, force=force)


@dataclass(frozen=True)
class BlindTrials:
    """Blind trials that were run."""

    journal: Path
    """One line for each trial, in their order: what was hidden, and the diagnosis."""
    page: str
    """The figures, as Markdown: the page of the book."""

    def records(self) -> list[dict[str, Any]]:
        """The trials of the journal."""
        with open(self.journal, encoding="utf-8") as lines:
            return [json.loads(line) for line in lines]


def blind(
    client: Client,
    trials: int,
    *,
    store: str | PathLike[str],
    seed: int = 1,
    population: str = "blind",
    shards: int | None = None,
    output: str | PathLike[str] | None = None,
    force: bool = False,
    retries: int = 5,
    deaths: int = 100,
    threads: int = 1,
    in_flight: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    progress: bool | Report = False,
) -> BlindTrials:
    """Run blind trials of the diagnosis in shards on the workers of a cluster.

    An independent simulator draws a run with a hidden error, or without one; the command `rins diagnose` of the worker gets the log
    and the rig file.

    Parameters
    ----------
    client : distributed.Client
        The client of the cluster.
    trials : int
        The number of trials. Each takes seconds to a minute.
    store : path-like or str
        Where the shards are kept: a folder that the client and all workers reach, or a URL of fsspec.
    seed : int
        The seed: trial number i under a seed is always the same.
    population : {"blind", "null"}
        ``"null"`` draws runs without an unmodeled error, for the rate of false alarms.
    shards : int, optional
        The number of shards; by default that in the store, otherwise four a thread, with at most 10 trials each.
    output : path-like, optional
        The journal of all trials on the machine of the client; by default ``trials.jsonl`` in a store that is a folder.
    threads : int
        The number of threads of a diagnosis.
    force, retries, deaths, in_flight, storage_options, progress
        As of `monte_carlo`.

    Returns
    -------
    BlindTrials
        The same as without shards, except for run times.

    Raises
    ------
    DataError
        If the store cannot be used or holds other trials, or the output exists.
    DistributedError
        If a shard failed more often than `retries` and `deaths` permit.
    """
    ensure_synchronous(client)
    _ensure_numbers({"trials": trials, "threads": threads}, 1)
    _ensure_numbers({"seed": seed, "retries": retries, "deaths": deaths}, 0)
    _ensure_numbers({"shards": shards, "in_flight": in_flight}, 1)
    if population not in ("blind", "null"):
        raise ValueError(f'population: {population!r}, expected "blind" or "null"')
    place = Store.at(store, storage_options)
    if shards is None:
        shards = usual_shards(place, trials, threads_of(client), TRIALS_OF_A_SHARD)
    merged, _ = _output(place, output, _JOURNAL, force)
    work = Trials(
        shards=shards, threads=threads, store=place, population=population, trials=trials, seed=seed
    )
    _run_shards(client, work, "blind", (retries, deaths, in_flight), progress)
    with work.collected(merged.parent) as parts:
        page = _rins.blind_page([fspath(part) for part in parts], merged, population)
    return BlindTrials(merged, page)


def _run_shards(
    client: Client,
    work: Shards,
    name: str,
    limits: tuple[int, int, int | None],
    progress: bool | Report,
) -> None:
    """Claim the store and compute all shards that it lacks."""
    work.begin()
    count = _Count("running shards", work.shards, listener(progress))
    retries, deaths, in_flight = limits
    run_all(
        client,
        work.tasks(),
        name=f"rins-{name}",
        retries=retries,
        deaths=deaths,
        in_flight=in_flight,
        done=lambda task: count.add(),
        failed=_give_up,
    )
    work.store.remove_unfinished()


def _give_up(task: Task, error: BaseException, what: str) -> None:
    raise DistributedError(
        f"{task.label}: {what}, the last time with {type(error).__name__}: {error}",
        getattr(error, "file", None),
        getattr(error, "line", None),
        getattr(error, "key", None),
    ) from error


def _output(
    store: Store, output: str | PathLike[str] | None, name: str, force: bool
) -> tuple[Path, bool]:
    """The file of the merged results, and whether it is replaced if it exists."""
    if output is None:
        path = store.local(name)
        if path is None:
            raise ValueError("output: missing, expected a file for the merged results, since the store is not a folder")
        return path, True
    path = Path(output).absolute()
    if not path.parent.is_dir():
        raise DataError(f"{path}: there is no such folder", str(path))
    if path.exists() and not force:
        raise DataError(f"{path}: exists already; use force=True", str(path))
    return path, force


def diagnose_many(
    client: Client,
    rigs: Sequence[str | PathLike[str]],
    *,
    store: str | PathLike[str],
    model: str | PathLike[str] = "full",
    transfer: bool = False,
    hypothesis: str | PathLike[str] | None = None,
    noise: str = "likely",
    bootstrap: int | None = None,
    upload: bool = True,
    retries: int = 5,
    deaths: int = 100,
    in_flight: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    progress: bool | Report = False,
) -> list[Diagnosis]:
    """Diagnose many rigs on the workers of a cluster, each by itself.

    Parameters
    ----------
    client : distributed.Client
        The client of the cluster.
    rigs : sequence of path-like or str
        The rig files, or their URLs for fsspec. Files that a rig names lie where its paths lead from it.
    store : path-like or str
        Where the results are kept: a folder that the client and all workers reach, or a URL of fsspec.
    model, transfer, hypothesis, noise, bootstrap
        As of `rins.diagnose`. Workers get the content of model files.
    upload : bool
        Whether the client copies rig files and logs to the store, for the time of their diagnosis. With False the workers read the
        paths. URLs are always read by the workers.
    retries, deaths, in_flight, storage_options, progress
        As of `monte_carlo`.

    Returns
    -------
    list of Diagnosis
        In the order of `rigs`. A rig that cannot be diagnosed has an `Diagnosis.error` with file, line and key.

    Raises
    ------
    DataError
        If a model file cannot be read, or the store cannot be used.
    ValueError
        If a rig is given twice.

    Notes
    -----
    A diagnosis is kept if the SHA-256 of the rig file and of its logs, the arguments and the version of rins are those of its record.
    """
    ensure_synchronous(client)
    _ensure_numbers({"retries": retries, "deaths": deaths}, 0)
    _ensure_numbers({"bootstrap": bootstrap, "in_flight": in_flight}, 1)
    options = Options(
        model=_model(model) if fspath(model) != "full" else "full",
        hypothesis=None if hypothesis is None else _model(hypothesis),
        transfer=transfer,
        noise=noise,
        bootstrap=bootstrap,
    )
    diagnoses = Diagnoses([fspath(rig) for rig in rigs], options, Store.at(store, storage_options))
    diagnoses.begin()
    count = _Count("diagnosing", len(rigs), listener(progress))

    def done(task: Task) -> None:
        diagnoses.end(task.number)
        count.add()

    def failed(task: Task, error: BaseException, what: str) -> None:
        with contextlib.suppress(OSError):
            diagnoses.end(task.number)
        diagnoses.fail(task.number, error, what)
        count.add()

    run_all(
        client,
        diagnoses.tasks(upload, count.add),
        name="rins-diagnose",
        retries=retries,
        deaths=deaths,
        in_flight=in_flight,
        done=done,
        failed=failed,
    )
    diagnoses.store.remove_unfinished()
    return diagnoses.results()


class _Count:
    """The number of tasks that are done, for progress reports."""

    def __init__(self, stage: str, total: int, report: Report | None) -> None:
        self.stage, self.total, self.report, self.done = stage, total, report, 0
        self._tell()

    def add(self) -> None:
        self.done += 1
        self._tell()

    def _tell(self) -> None:
        if self.report is not None:
            self.report(self.stage, self.done, self.total)


def _ensure_numbers(numbers: Mapping[str, int | None], least: int) -> None:
    for name, number in numbers.items():
        if number is not None and (not isinstance(number, int) or number < least):
            raise ValueError(f"{name}: {number!r}, expected a number of at least {least}")


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise DataError(f"cannot read {path}: {error.strerror}", str(path)) from error


def _model_option(model: str | PathLike[str]) -> ModelOption:
    """A model by its name or with the content of its file."""
    name = fspath(model)
    return ModelOption(name, None if name in ("paper12", "full") else _read(Path(model)))


def _model(path: str | PathLike[str]) -> tuple[str, bytes]:
    """The name and the content of a model file."""
    return fspath(path), _read(Path(path))
