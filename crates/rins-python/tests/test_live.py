"""Calibration while a log is written."""

from __future__ import annotations

import json
import subprocess
import sysconfig
from pathlib import Path

import numpy as np
import pytest
import rins
from conftest import RIG

LOG = RIG.with_name("run.csv").read_bytes()


def fed(live: rins.LiveCalibration, data: bytes, portion: int) -> int:
    return sum(live.feed(data[i : i + portion]) for i in range(0, len(data), portion))


def sigmas(live: rins.LiveCalibration) -> dict[str, float]:
    parameters = live.parameters
    assert parameters is not None
    return {one["id"]: one["sigma"] for one in parameters}


@pytest.fixture(scope="module")
def expected() -> str:
    """The result of the command, which reads the log from standard input."""
    script = Path(sysconfig.get_path("scripts")) / "rins"
    words = [script, "calibrate", RIG, "--live=-", "--json"]
    done = subprocess.run(list(map(str, words)), input=LOG, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()


def test_result_is_that_of_the_command_for_any_portions(expected: str) -> None:
    for portion in (1 << 20, 4099):
        live = rins.LiveCalibration(RIG)
        assert fed(live, LOG, portion) == LOG.count(b"\n") - 1
        res = live.end()
        assert res.to_json() + "\n" == expected
    assert len(res.names) == len(res.x) == len(res.se) == len(res.units) == len(res.identified)
    assert np.allclose(np.sqrt(np.diag(res.cov)), res.se)
    z = res.names.index("gyro.scale.z")
    assert res.identified[z] and not res.identified.all()
    assert res.summary().startswith("Live calibration")
    with pytest.raises(ValueError, match="has ended"):
        live.feed(b"")
    with pytest.raises(ValueError, match="has ended"):
        live.end()


def test_estimates_are_there_while_the_log_grows() -> None:
    live = rins.LiveCalibration(RIG, start=5.0)
    assert live.parameters is None and live.time is None
    assert "samples of the start" in live.line()
    half = LOG.index(b"\n", len(LOG) // 2) + 1
    live.feed(LOG[:half])
    first = sigmas(live)
    assert live.time is not None and f"{live.time:.1f} s" in live.line()
    live.feed(LOG[half:])
    second = sigmas(live)
    assert first.keys() == second.keys() and len(first) == 27
    assert second["gyro.scale.z"] < first["gyro.scale.z"]


def test_checkpoint_continues_to_the_same_bytes(expected: str, tmp_path: Path) -> None:
    state = tmp_path / "state.json"
    live = rins.LiveCalibration(RIG)
    assert not live.write_checkpoint(state) and not state.exists()
    live.feed(LOG[: len(LOG) // 3])
    assert live.write_checkpoint(state)
    again = rins.LiveCalibration(RIG, resume=state)
    fed(again, LOG, 1 << 16)
    assert json.loads(again.end().to_json())["parameters"] == json.loads(expected)["parameters"]
    with pytest.raises(rins.DataError, match="not a checkpoint"):
        rins.LiveCalibration(RIG, resume=RIG)


def test_errors_name_the_row_and_the_argument(tmp_path: Path) -> None:
    live = rins.LiveCalibration(RIG, source="port")
    rows = LOG.splitlines(keepends=True)
    live.feed(b"".join(rows[:1000]))
    with pytest.raises(rins.DataError) as caught:
        live.feed(b"1,2,three\n")
    assert (caught.value.file, caught.value.line) == ("port", 1001)
    for wrong in ({"start": 0.0}, {"duration": float("nan")}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            rins.LiveCalibration(RIG, **wrong)  # type: ignore[arg-type]
    with pytest.raises(rins.DataError, match="the paper's filter takes a finished log"):
        rins.LiveCalibration(RIG, "paper12")
    with pytest.raises(rins.DataError) as caught:
        rins.LiveCalibration(tmp_path / "none.toml")
    assert caught.value.file == str(tmp_path / "none.toml")
