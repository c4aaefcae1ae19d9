"""Data of the repository, for all tests."""

from __future__ import annotations

import subprocess
import sysconfig
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[3]
RIG = ROOT / "crates/rins/data/demo/rig.toml"
"""The rig file of the embedded run: 380 s at 25 Hz of increments with a table angle."""

SCENARIO = RIG.with_name("scenario.toml")

SHORT = """
[site]
latitude = "45 deg"
height = "0 m"
[log]
rate = "50 Hz"
table_angle = { noise = "1 arcsec" }
[table]
profile = [
    { rate = "0 deg/s", duration = "20 s" },
    { rate = "20 deg/s", duration = "40 s" },
    { rate = "-20 deg/s", duration = "40 s" },
]
[attitude]
roll = "0 deg"
pitch = "25 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu]
grade = "fog"
[truth]
seed = 1
[truth.gyro]
scale = ["0 ppm", "0 ppm", "200 ppm"]
"""
"""A scenario of 100 s."""

Command = Callable[..., bytes]


@pytest.fixture(scope="session")
def command() -> Command:
    """The command `rins` of this environment; its standard output."""
    script = Path(sysconfig.get_path("scripts")) / "rins"

    def run(*words: object) -> bytes:
        done = subprocess.run([script, *map(str, words)], capture_output=True, check=False)
        assert done.returncode == 0, done.stderr.decode()
        return done.stdout

    return run


@pytest.fixture(scope="session")
def short(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The rig file of a run of 100 s, with a scenario beside it."""
    import rins

    folder = tmp_path_factory.mktemp("short")
    scenario = folder / "scenario.toml"
    scenario.write_text(SHORT, encoding="utf-8")
    rins.simulate(scenario).write(folder / "run")
    return folder / "run" / "rig.toml"


@pytest.fixture(scope="session")
def calibrations(tmp_path_factory: pytest.TempPathFactory, short: Path) -> list[Path]:
    """Three calibration files of runs with different noise."""
    import rins

    folder = tmp_path_factory.mktemp("calibrations")
    files = []
    for seed in (1, 2, 3):
        run = rins.simulate(short.parent.with_name("scenario.toml"), seed=seed).recording()
        rins.calibrate(run, "full").write(folder / str(seed))
        files.append(folder / str(seed) / "calibration.toml")
    return files


@pytest.fixture(scope="session")
def columns() -> dict[str, NDArray[np.float64]]:
    """The columns of the embedded run: t [s], gyro (n, 3) [rad], accel (n, 3) [m/s], table_angle [rad]."""
    rows = np.loadtxt(RIG.with_name("run.csv"), delimiter=",", skiprows=1)
    return {"t": rows[:, 0], "gyro": rows[:, 1:4], "accel": rows[:, 4:7], "table_angle": rows[:, 7]}
