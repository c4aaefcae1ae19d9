"""Calls: errors, interrupts, progress, threads."""

from __future__ import annotations

import itertools
import pickle
import re
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import rins
from conftest import RIG, ROOT, SHORT
from numpy.typing import NDArray
from rins._rig import Sections

CAMPAIGN = ROOT / "scenarios/paper/section-4-1.toml"


def test_errors_state_file_line_and_key(tmp_path: Path) -> None:
    text = RIG.read_text(encoding="utf-8")
    bad = tmp_path / "rig.toml"
    bad.write_text(text.replace('"0.02 deg/h/sqrt(Hz)"', '"0.02 deg/h"'), encoding="utf-8")
    line = 1 + text[: text.index('"0.02 deg/h/sqrt(Hz)"')].count("\n")
    for call in (rins.Recording.open, rins.read_rig, rins.check, rins.calibrate):
        with pytest.raises(rins.DataError) as caught:
            call(bad)
        error = caught.value
        assert (error.file, error.line, error.key) == (str(bad), line, "[imu.gyro] noise")
        assert f"rig.toml:{line}:" in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line, again.key) == (str(error), error.line, error.key)

    bad.write_text(text, encoding="utf-8")
    rows = RIG.with_name("run.csv").read_text(encoding="utf-8").replace("gyro_y", "gyro_w", 1)
    (tmp_path / "run.csv").write_text(rows, encoding="utf-8")
    with pytest.raises(rins.DataError, match="did you mean|columns are") as missing:
        rins.calibrate(bad)
    assert missing.value.file == str(tmp_path / "run.csv") and missing.value.key == "gyro_y"

    with pytest.raises(rins.DataError) as absent:
        rins.calibrate(tmp_path / "no.toml")
    assert absent.value.file == str(tmp_path / "no.toml") and absent.value.line is None


def test_errors_of_a_model_are_model_errors(tmp_path: Path) -> None:
    model = tmp_path / "model.toml"
    model.write_text("[[terms]]\nid = 'no_such_effect'\n", encoding="utf-8")
    with pytest.raises(rins.ModelError) as caught:
        rins.calibrate(RIG, model)
    assert caught.value.file == str(model)
    for wrong in ("half", ""):
        with pytest.raises(ValueError, match="model"):
            rins.calibrate(RIG, wrong)
    with pytest.raises(ValueError, match="noise"):
        rins.calibrate(RIG, noise="loud")
    with pytest.raises(ValueError, match="twice"):
        rins.calibrate([RIG, RIG])
    with pytest.raises(ValueError, match="no run"):
        rins.calibrate([])
    with pytest.raises(ValueError, match="max_rate"):
        rins.observe(CAMPAIGN, max_rate="3 deg")


INTERRUPT = """
import os, signal, sys, threading, time
import rins
sent = []
def send():
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
def begun(stage, done, total):
    if not sent and stage == {stage!r}:
        threading.Timer(0.2, send).start()
try:
    {call}
except KeyboardInterrupt:
    print(time.perf_counter() - sent[0])
    sys.exit(0)
sys.exit(3)
"""


@pytest.mark.parametrize(
    ("stage", "call"),
    [
        ("estimating the model", f"rins.diagnose({str(RIG)!r}, bootstrap=1000, progress=begun)"),
        ("running", f"rins.monte_carlo({str(CAMPAIGN)!r}, 10**6, 'runs.parquet', progress=begun)"),
    ],
)
def test_interrupt_returns_within_a_fifth_of_a_second(
    stage: str, call: str, tmp_path: Path
) -> None:
    code = INTERRUPT.format(stage=stage, call=call)
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, cwd=tmp_path, check=False, timeout=60
    )
    assert run.returncode == 0, run.stderr.decode()
    assert 0.0 < float(run.stdout) < 0.2


def test_progress_is_reported_and_its_exceptions_are_raised(
    short: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    reports: list[tuple[str, int | None, int | None]] = []
    result = rins.calibrate(short, progress=lambda *report: reports.append(report))
    assert {stage for stage, _, _ in reports} == {"calibrating"}
    assert reports[0][1] == 0 and reports[-1][1] == reports[-1][2]
    assert result.to_json() == rins.calibrate(short).to_json()

    rins.calibrate(short, progress=True)
    assert "calibrating" in capsys.readouterr().err

    def refuse(stage: str, done: int | None, total: int | None) -> None:
        raise LookupError(stage)

    with pytest.raises(LookupError, match="calibrating"):
        rins.calibrate(short, progress=refuse)


def test_threads_run_at_the_same_time(short: Path) -> None:
    # Each call waits in its progress report for the other: both are under way, and neither holds the GIL.
    barrier = threading.Barrier(2)
    met: list[int] = []
    failed: list[BaseException] = []

    def calibrate() -> None:
        waited: list[bool] = []

        def meet(stage: str, done: int | None, total: int | None) -> None:
            if not waited:
                waited.append(True)
                met.append(barrier.wait(timeout=30))

        try:
            rins.calibrate(short, "full", progress=meet)
        except BaseException as error:  # noqa: BLE001
            failed.append(error)

    threads = [threading.Thread(target=calibrate) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed and sorted(met) == [0, 1]


def test_python_goes_on_during_a_call() -> None:
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    rins.calibrate(RIG, "full")
    duration = time.perf_counter() - start
    done.set()
    thread.join()
    during = [one for one in ticks if start < one < start + duration]
    assert duration > 0.1
    # With the GIL held there would be a gap as long as the call.
    gaps = [later - earlier for earlier, later in itertools.pairwise(during)]
    assert len(during) > 20 and max(gaps) < 0.5 * duration


def test_import_is_quick() -> None:
    code = textwrap.dedent(
        """
        import sys, time
        start = time.process_time()
        import rins
        taken = time.process_time() - start
        assert "numpy" not in sys.modules
        print(taken)
        """
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
        for _ in range(5)
    ]
    assert min(float(run.stdout) for run in runs) < 0.1


def test_rigs_are_made_of_sections(tmp_path: Path) -> None:
    scenario = tmp_path / "scenario.toml"
    scenario.write_text(SHORT, encoding="utf-8")
    run = rins.simulate(scenario).recording()
    sections = run.rig.sections
    again = rins.Rig(**sections)
    assert again.sections == sections
    with pytest.raises(rins.DataError) as caught:
        rins.Rig(**{**sections, "site": {"latitude": "45 m", "height": "0 m"}})
    assert caught.value.key == "[site] latitude"
    odd = 'quote " and \\ and \t'
    assert rins.Rig(**{**sections, "run": {"note": odd}}).sections["run"]["note"] == odd


def test_sections_are_those_of_rig_files(columns: dict[str, NDArray[np.float64]]) -> None:
    source = (ROOT / "crates/rins-io/src/rig/mod.rs").read_text(encoding="utf-8")
    listed = re.search(r"const SECTIONS: \[&str; \d+\] =\s*\[(.*?)\]", source, re.DOTALL)
    assert listed is not None
    assert set(Sections.__annotations__) == set(re.findall(r'"(\w+)"', listed[1]))
    with pytest.raises(TypeError, match="'mirror' is no section"):
        rins.Rig(mirror={})  # type: ignore[call-arg]

    given = {"scale": ["0 ppm", "0 ppm", "1 ppm"], "misalignment": {"xz": "30 arcsec"}}
    rig = rins.read_rig(RIG).sections
    rec = rins.Recording(
        columns["t"],
        columns["gyro"],
        columns["accel"],
        table_angle=columns["table_angle"],
        units={"t": "s", "gyro": "rad", "accel": "m/s", "table_angle": "rad"},
        axes="xyz",
        tolerance={"gyro": given},
        site=rig["site"],
        imu=rig["imu"],
    )
    assert rec.rig.sections["tolerance"] == {"gyro": given}
    # The embedded run has a scale error of 300 ppm and a misalignment of 60 arcsec.
    stated = {one["id"]: one["statement"] for one in rins.calibrate(rec, "full")["conformity"]}
    assert stated == {"gyro.misalignment.xz": "fail", "gyro.scale.z": "fail"}


def test_types_are_those_of_the_schemas() -> None:
    script = ROOT / "crates/rins-python/schema_types.py"
    subprocess.run([sys.executable, script, "--check"], check=True)
