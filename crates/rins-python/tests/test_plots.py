"""Plots."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import pytest
import rins
from conftest import RIG, ROOT

matplotlib.use("Agg")


def test_plots_show_what_results_state(short: Path) -> None:
    result = rins.calibrate(short, "full")
    ax = result.plot(unit="ppm")
    labels = [label.get_text() for label in ax.get_yticklabels()]
    assert labels == [name for name, unit in zip(result.names, result.units) if unit == "ppm"]
    with pytest.raises(ValueError, match="furlong"):
        result.plot(unit="furlong")
    assert len(rins.allan(RIG).plot(sensor="accel").collections) == 3
    mission = rins.mission(ROOT / "scenarios/service/fixed-45deg.toml")
    lines = mission.plot().get_lines()
    assert [line.get_label() for line in lines] == [one["name"] for one in mission["schemes"]]
    observed = rins.observe(ROOT / "scenarios/schedules/ii-reversal.toml")
    assert len(observed.plot().patches) == len(observed["schedules"][0]["parameters"])
    assert rins.diagnose(short).plot().get_title().startswith("rins diagnose")
