"""Every command gives the same bytes as JSON from Python and from the command line."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rins
from conftest import RIG, ROOT, SCENARIO, Command

MISSION = ROOT / "scenarios/service/fixed-45deg.toml"
SCHEDULE = ROOT / "scenarios/schedules/ii-reversal.toml"
CAMPAIGN = ROOT / "scenarios/paper/section-4-1.toml"

Case = tuple[list[object], Callable[[Path], "rins.Result[Any]"]]


def without_time(printed: bytes) -> bytes:
    """JSON without the run time of a diagnosis, the only number that differs between two calls."""
    return re.sub(rb'"seconds":[0-9.e-]+', b'"seconds":0', printed)


CASES: dict[str, Case] = {
    "check": (["check", RIG], lambda _: rins.check(RIG)),
    "allan": (["allan", RIG], lambda _: rins.allan(str(RIG))),
    "align": (["align", RIG], lambda _: rins.align(RIG)),
    "navigate": (["navigate", RIG], lambda _: rins.navigate(RIG)),
    "calibrate": (["calibrate", RIG], lambda _: rins.calibrate(RIG)),
    "calibrate full": (
        ["calibrate", RIG, "--model", "full", "--noise", "given"],
        lambda _: rins.calibrate([RIG], model="full", noise="given"),
    ),
    "demo": (["demo", "-o", "demo"], lambda _: rins.demo()),
    "init": (["init", RIG.with_name("run.csv")], lambda _: rins.init(RIG.with_name("run.csv"))),
    "simulate": (
        ["simulate", SCENARIO, "--seed", "7", "-o", "run"],
        lambda _: rins.simulate(SCENARIO, seed=7),
    ),
    "observe": (
        ["observe", SCHEDULE, "--model", "paper12"],
        lambda _: rins.observe(SCHEDULE, model="paper12"),
    ),
    "design": (
        ["design", SCHEDULE, "--for", "gyro.scale.x", "--directions", "1"],
        lambda _: rins.design(SCHEDULE, "gyro.scale.x", directions=1),
    ),
    "mission": (["mission", MISSION], lambda _: rins.mission(MISSION)),
    "convert": (
        ["convert", RIG, "-o", "log.parquet"],
        lambda _: rins.convert(RIG, "log.parquet", force=True),
    ),
    "monte-carlo": (
        ["monte-carlo", CAMPAIGN, "--runs", "2", "--seed", "5", "-o", "runs.parquet"],
        lambda _: rins.monte_carlo(CAMPAIGN, 2, "runs.parquet", seed=5, force=True),
    ),
    "monte-carlo of a model": (
        ["monte-carlo", CAMPAIGN, "--runs", "2", "--model", "full", "-o", "runs.parquet"],
        lambda _: rins.monte_carlo(CAMPAIGN, 2, "runs.parquet", model="full", force=True),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_json_is_that_of_the_command(
    name: str, command: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words, call = CASES[name]
    monkeypatch.chdir(tmp_path)
    printed = command(*words, "--json")
    result = call(tmp_path)
    assert without_time(result.to_json().encode()) + b"\n" == without_time(printed)
    assert result.data == json.loads(result.to_json())


def test_json_of_several_runs_is_that_of_the_command(
    command: Command,
    short: Path,
    calibrations: list[Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)

    def same(result: rins.Result[Any], *words: object) -> None:
        printed = command(*words, "--json")
        assert without_time(result.to_json().encode()) + b"\n" == without_time(printed), words[0]

    same(rins.diagnose(short), "diagnose", short)
    same(rins.compare(*calibrations[:2]), "compare", *calibrations[:2])
    same(rins.history(calibrations, temperature=-5.0), "history", *calibrations, "--temperature=-5")
    calibration = calibrations[0]
    same(
        rins.navigate(short, calibration=calibration),
        *("navigate", short, "--calibration", calibration),
    )
    words = ("apply", short, "--calibration", calibration, "-o", "clean.csv", "--force")
    same(rins.apply(short, calibration, "clean.csv"), *words)
    parts = []
    for i in (1, 2):
        parts.append(f"part{i}.parquet")
        rins.monte_carlo(CAMPAIGN, 4, parts[-1], shard=(i, 2))
    same(rins.merge(parts, "all.parquet"), "merge", *parts, "-o", "all.parquet", "--force")


def test_text_page_and_folder_are_those_of_the_command(
    command: Command, short: Path, tmp_path: Path
) -> None:
    printed = command("calibrate", short, "--model", "full", "-o", tmp_path / "theirs")
    result = rins.calibrate(short, "full")
    page = result.write(tmp_path / "ours")
    assert page == tmp_path / "ours" / "report.html"
    assert printed.decode().startswith(result.summary())
    names = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "ours").iterdir())
    for name in names:
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert result.page() == page.read_text(encoding="utf-8")
    with pytest.raises(rins.DataError, match="exists already"):
        result.write(tmp_path / "ours")
    assert result.write(tmp_path / "ours", force=True) == page


def test_data_that_cannot_be_used_have_a_failure(short: Path, tmp_path: Path) -> None:
    text = short.read_text(encoding="utf-8")
    assert text.count('unit = "m/s"') == 1
    wrong = text.replace('unit = "m/s"', 'unit = "ug*s"')
    (tmp_path / "rig.toml").write_text(wrong, encoding="utf-8")
    (tmp_path / "run.csv").write_bytes(short.with_name("run.csv").read_bytes())
    assert rins.check(short).failure is None
    assert rins.check(tmp_path / "rig.toml").failure
    with pytest.raises(rins.DataError):
        rins.calibrate(tmp_path / "rig.toml")


def test_console_script_has_the_exit_codes_of_the_command(tmp_path: Path) -> None:
    import subprocess
    import sys

    def code(*words: str) -> int:
        return subprocess.run(
            [sys.executable, "-m", "rins", *words], capture_output=True, check=False
        ).returncode

    assert code("--version") == 0
    assert code("check", str(tmp_path / "missing.toml")) == 1
    assert code("calibrate", "--model", "half", str(RIG)) == 2
