"""Arrays and tables in and out."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
import rins
from conftest import RIG
from numpy.typing import NDArray

Columns = dict[str, NDArray[np.float64]]
UNITS = {"t": "s", "gyro": "rad", "accel": "m/s", "table_angle": "rad"}


def of_arrays(columns: Columns, **changes: Any) -> rins.Recording:
    sections = rins.read_rig(RIG).sections
    accuracy = {key: sections["log"]["table_angle"][key] for key in ("noise", "resolution")}
    keywords: dict[str, Any] = {
        "units": UNITS,
        "axes": "xyz",
        "site": sections["site"],
        "attitude": sections["attitude"],
        "imu": sections["imu"],
        "table": sections["table"],
        "log": {"rate": sections["log"]["rate"], "table_angle": accuracy},
    }
    return rins.Recording(**{**columns, **keywords, **changes})


def frame(columns: Columns) -> dict[str, NDArray[np.float64]]:
    """The columns with the names of the rig file."""
    named = {"time": columns["t"], "table_angle": columns["table_angle"]}
    for sensor in ("gyro", "accel"):
        named.update({f"{sensor}_{axis}": columns[sensor][:, i] for i, axis in enumerate("xyz")})
    return named


def test_arrays_give_the_estimates_of_the_file(columns: Columns) -> None:
    read, made = rins.Recording.open(RIG), of_arrays(columns)
    assert len(made) == len(read) > 9000
    for name in ("t", "gyro", "accel", "table_angle"):
        np.testing.assert_array_equal(getattr(made, name), getattr(read, name))
    of_file, ours = rins.calibrate(read), rins.calibrate(made)
    assert of_file.to_json() == rins.calibrate(RIG).to_json()
    np.testing.assert_array_equal(ours.x, of_file.x)
    np.testing.assert_array_equal(ours.cov, of_file.cov)
    assert ours.names == ["gyro.misalignment.xz", "gyro.misalignment.yz", "gyro.scale.z"]
    assert ours.units == ["arcsec", "arcsec", "ppm"]
    np.testing.assert_allclose(np.sqrt(np.diag(ours.cov)), ours.se, rtol=1e-12)
    assert np.all(ours.se > 0.0)
    # The truth is in scenario.toml.
    np.testing.assert_array_less(np.abs(ours.x - [60.0, 60.0, 300.0]), 10.0)
    # Provenance: the digest of the arrays stands for that of the file.
    inputs = ours["provenance"]["inputs"]
    assert [one["path"] for one in inputs] == ["arrays", "arrays"]
    assert len(inputs[1]["sha256"]) == 64
    changed = {**columns, "t": columns["t"] + 1.0}
    assert of_arrays(changed).inputs[1] != made.inputs[1]


def test_recordings_are_compensated_as_the_file_is(columns: Columns, tmp_path: Path) -> None:
    made = of_arrays(columns)
    rins.calibrate(made).write(tmp_path / "out")
    calibration = tmp_path / "out" / "calibration.toml"
    rins.apply(RIG, calibration, tmp_path / "clean.parquet")
    written = rins.Recording.open(tmp_path / "clean.toml")
    ours = made.compensated(calibration)
    for name in ("t", "gyro", "accel", "table_angle"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(written, name))
    assert np.abs(ours.gyro - made.gyro).max() > 1e-5
    # Its own scale error is none any more.
    left = rins.calibrate(ours)
    assert abs(left.x[2]) < 5.0 * left.se[2]
    assert str(calibration) in [name for name, _ in ours.inputs]
    text = calibration.read_text(encoding="utf-8")
    slow = re.sub(r"(?m)^rate = .*$", 'rate = ["-1 deg/s", "1 deg/s"]', text)
    assert slow != text
    calibration.write_text(slow, encoding="utf-8")
    with pytest.warns(UserWarning, match="calibrated up to"):
        made.compensated(calibration)
    calibration.write_text("", encoding="utf-8")
    with pytest.raises(rins.DataError):
        made.compensated(calibration)


def test_memory_layout_does_not_matter(columns: Columns) -> None:
    expected = of_arrays(columns)
    fortran = {name: np.asfortranarray(one) for name, one in columns.items()}
    backward = {name: np.ascontiguousarray(one[::-1])[::-1] for name, one in columns.items()}
    listed = {name: one.tolist() for name, one in columns.items()}
    layouts: list[dict[str, Any]] = [fortran, backward, listed]
    for layout in layouts:
        made = of_arrays(layout)
        np.testing.assert_array_equal(made.gyro, expected.gyro)
        assert made.inputs[1] == expected.inputs[1]


def test_arrays_are_not_copied(columns: Columns) -> None:
    size = sum(one.nbytes for one in columns.values())
    assert size > 500_000
    tracemalloc.start()
    recording = of_arrays(columns)
    in_peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    arrays = (recording.t, recording.gyro, recording.accel, recording.table_angle)
    out_peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # NumPy reports its memory: a copy of one column alone would be 76 kB.
    assert in_peak < 60_000 and out_peak < in_peak + 60_000, (in_peak, out_peak)
    assert arrays[1].shape == (len(recording), 3) and not arrays[1].flags.writeable

    def address(array: NDArray[np.float64]) -> int:
        return int(array.__array_interface__["data"][0])

    assert address(recording.gyro) == address(recording.gyro)
    table: Any = recording.to_arrow().to_pyarrow()
    shown: Any = recording.to_arrow().to_polars()
    for name, array in (("t", recording.t), ("gyro_z", recording.gyro[:, 2])):
        assert table[name].chunk(0).buffers()[1].address + 8 * table[name].chunk(
            0
        ).offset == address(array)
        assert address(shown[name].to_numpy(allow_copy=False)) == address(array)
    # The memory outlives the recording.
    view = recording.accel
    expected = view.copy()
    del recording, arrays, table, shown
    np.testing.assert_array_equal(view, expected)


@pytest.mark.parametrize("library", ["pandas", "polars", "pyarrow", "chunks"])
def test_tables_are_read(library: str, columns: Columns) -> None:
    named = frame(columns)
    makers: dict[str, Callable[[], Any]] = {
        "pandas": lambda: pd.DataFrame(named),
        "polars": lambda: pl.DataFrame(named),
        "pyarrow": lambda: pa.table(named),
        "chunks": lambda: pa.concat_tables([pa.table(named)[:4000], pa.table(named)[4000:]]),
    }
    data = makers[library]()
    expected = rins.Recording.open(RIG)
    made = rins.Recording.from_table(data, RIG)
    np.testing.assert_array_equal(made.gyro, expected.gyro)
    np.testing.assert_array_equal(made.t, expected.t)
    back = made.to_arrow()
    assert back.column_names[:2] == ["t", "gyro_x"] and back.num_rows == len(made)
    frames: dict[str, Callable[[], Any]] = {"pandas": back.to_pandas, "polars": back.to_polars}
    frame_back = frames.get(library, back.to_pyarrow)()
    np.testing.assert_array_equal(np.asarray(frame_back["gyro_y"]), made.gyro[:, 1])


def test_integer_time_stamps_keep_their_digits(columns: Columns) -> None:
    named: dict[str, Any] = frame(columns)
    stamps = 1_800_000_000_000_000_000 + np.round(columns["t"] * 1e9).astype(np.int64)
    sections = rins.read_rig(RIG).sections
    sections["log"]["time"]["unit"] = "ns"
    rig = rins.Rig(**sections)
    expected = rins.Recording.open(RIG)
    for time in (stamps, stamps.view("datetime64[ns]")):
        named["time"] = time
        made = rins.Recording.from_table(pd.DataFrame(named), rig)
        assert len(made) == len(expected)
        # An f64 of this epoch resolves 256 ns.
        np.testing.assert_allclose(np.diff(made.t), np.diff(expected.t), atol=2e-9)
    units = {**UNITS, "t": "ns"}
    of_integers = of_arrays(columns, t=stamps, units=units)
    np.testing.assert_allclose(np.diff(of_integers.t), np.diff(expected.t), atol=2e-9)


def test_nothing_is_guessed(columns: Columns) -> None:
    def refused(**changes: Any) -> rins.DataError:
        with pytest.raises(rins.DataError) as caught:
            of_arrays(columns, **changes)
        return caught.value

    without = {name: unit for name, unit in UNITS.items() if name != "accel"}
    error = refused(units=without)
    assert error.key == "units['accel']" and '"m/s^2"' in str(error)
    assert refused(axes=None).key == "axes"
    assert refused(axes={"gyro": "xyz"}).key == "axes['accel']"
    assert "gyro.axes" in str(refused(axes="xyx"))
    assert "unknown unit" in str(refused(units={**UNITS, "gyro": "furlong"}))
    assert refused(units={**UNITS, "table_rate": "deg/s"}).key == "units['table_rate']"
    assert refused(gyro=columns["gyro"][:, :2]).key == "gyro"
    assert "samples" in str(refused(accel=columns["accel"][:-1]))
    assert refused(t=columns["t"].astype(str)).key == "t"
    # Degrees that are stated to be radians are not plausible, or refused by the check of the run.
    with pytest.raises(rins.DataError):
        rins.calibrate(of_arrays(columns, units={**UNITS, "gyro": "deg"}))


def test_damaged_rows_are_reported(columns: Columns) -> None:
    gyro = columns["gyro"].copy()
    gyro[100, 1] = np.nan
    made = of_arrays({**columns, "gyro": gyro})
    assert len(made) == len(of_arrays(columns)) - 1
    assert any("101" in repair for repair in made.repairs), made.repairs
    gyro[:500, 1] = np.inf
    with pytest.raises(rins.DataError, match="not finite") as caught:
        of_arrays({**columns, "gyro": gyro})
    assert (caught.value.file, caught.value.line, caught.value.key) == ("arrays", 1, "gyro_y")


def test_axes_are_those_that_are_stated(columns: Columns) -> None:
    # Body x is against y of the sensor, body y along x of the sensor.
    turned = columns["gyro"][:, [1, 0, 2]] * [1.0, -1.0, 1.0]
    made = of_arrays({**columns, "gyro": turned}, axes={"gyro": ["-y", "x", "z"], "accel": "xyz"})
    np.testing.assert_array_equal(made.gyro, of_arrays(columns).gyro)


def test_results_are_tables(short: Path) -> None:
    result = rins.calibrate(short, "full")
    table = result.to_arrow().to_pyarrow()
    assert table["id"].to_pylist() == [one["id"] for one in result["parameters"]]
    np.testing.assert_array_equal(table["value"].to_numpy(), result.x)
    assert table.schema.field("identifiable").type == pa.bool_()
    assert isinstance(result.to_arrow().to_frame(), pl.DataFrame)
    with pytest.raises(KeyError, match="parameters"):
        result.to_arrow("model")
    html = result._repr_html_()
    assert "<table>" in html and "gyro.scale.z" in html
    assert list(result) == list(result.data) and len(result) > 10
