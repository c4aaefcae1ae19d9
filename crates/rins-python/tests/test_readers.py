"""Readers of formats, with files that their own libraries write. A reader whose library is not installed is skipped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rins
import rins.readers

N = 400
SITE = {"latitude": "45 deg", "height": "0 m"}
STAMPS = 1_700_000_000_000_000_000 + 5_000_000 * np.arange(1, N + 1, dtype=np.int64)
T = np.arange(N)
GYRO = np.stack([1e-3 * np.sin(0.1 * T), 2e-3 * np.cos(0.07 * T), 0.1 + 1e-4 * T], axis=1)
ACCEL = np.stack([0.1 * np.sin(0.2 * T), 0.05 + 1e-5 * T, 9.8 + 1e-4 * T], axis=1)


def expected() -> rins.Recording:
    units = {"t": "ns", "gyro": "rad/s", "accel": "m/s^2"}
    return rins.Recording(STAMPS, GYRO, ACCEL, units=units, axes="xyz", site=SITE)


def same(recording: rins.Recording) -> None:
    np.testing.assert_array_equal(recording.gyro, expected().gyro)
    np.testing.assert_array_equal(recording.accel, expected().accel)
    np.testing.assert_allclose(np.diff(recording.t), 0.005, atol=1e-8)


def test_bags_are_read(tmp_path: Path) -> None:
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
    types = store.types
    vector, imu = types["geometry_msgs/msg/Vector3"], types["sensor_msgs/msg/Imu"]
    header, time = types["std_msgs/msg/Header"], types["builtin_interfaces/msg/Time"]
    turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    with rosbag2.Writer(tmp_path / "bag", version=9) as writer:
        connection = writer.add_connection("/imu", imu.__msgtype__, typestore=store)
        for stamp, rate, force in zip(STAMPS.tolist(), GYRO, ACCEL, strict=True):
            own = header(time(stamp // 10**9, stamp % 10**9), "imu")
            nine = np.zeros(9)
            message = imu(own, turn, nine, vector(*rate), nine, vector(*force), nine)
            writer.write(connection, stamp, store.serialize_cdr(message, imu.__msgtype__))
    same(rins.readers.ros(tmp_path / "bag", "/imu", axes="xyz", site=SITE))
    with pytest.raises(rins.DataError, match="/imu"):
        rins.readers.ros(tmp_path / "bag", "/other", axes="xyz", site=SITE)


DEFINITION = """std_msgs/Header header
geometry_msgs/Vector3 angular_velocity
geometry_msgs/Vector3 linear_acceleration
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""


def test_mcap_files_are_read(tmp_path: Path) -> None:
    writer_module = pytest.importorskip("mcap_ros2.writer")
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = writer_module.Writer(file)
        schema = writer.register_msgdef("sensor_msgs/msg/Imu", DEFINITION)
        for stamp, rate, force in zip(STAMPS.tolist(), GYRO.tolist(), ACCEL.tolist(), strict=True):
            message = {
                "header": {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}},
                "angular_velocity": dict(zip("xyz", rate, strict=True)),
                "linear_acceleration": dict(zip("xyz", force, strict=True)),
            }
            writer.write_message("/imu", schema, message, log_time=stamp, publish_time=stamp)
        writer.finish()
    same(rins.readers.mcap(path, "/imu", axes="xyz", site=SITE))
    with pytest.raises(rins.DataError, match="/imu"):
        rins.readers.mcap(path, "/other", axes="xyz", site=SITE)


def test_matlab_files_are_read(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "log.mat"
    with h5py.File(path, "w") as file:
        # As MATLAB stores a column and matrices of n rows.
        file["time"] = STAMPS[np.newaxis, :]
        file["w"], file["f"] = GYRO.T, ACCEL.T
    keywords: dict[str, Any] = {
        "units": {"t": "ns", "gyro": "rad/s", "accel": "m/s^2"},
        "axes": "xyz",
        "site": SITE,
        "transposed": True,
    }
    same(rins.readers.hdf5(path, t="time", gyro="w", accel="f", **keywords))
    with pytest.raises(rins.DataError, match="'w'"):
        rins.readers.hdf5(path, t="time", gyro="rate", accel="f", **keywords)


def test_flight_logs_are_read(tmp_path: Path) -> None:
    pytest.importorskip("pyulog")
    path = tmp_path / "log.ulg"
    path.write_bytes(ulog())
    recording = rins.readers.px4(path, axes="xyz", site=SITE)
    np.testing.assert_allclose(recording.gyro, expected().gyro, rtol=1e-6)
    np.testing.assert_allclose(recording.accel, expected().accel, rtol=1e-6)
    np.testing.assert_allclose(np.diff(recording.t), 0.005, atol=1e-9)
    with pytest.raises(rins.DataError, match="sensor_combined"):
        rins.readers.px4(path, axes="xyz", site=SITE, instance=1)


def ulog() -> bytes:
    """A ULog file, by the description of the format (docs.px4.io, ULog file format)."""
    import struct

    def message(kind: bytes, content: bytes) -> bytes:
        return struct.pack("<Hc", len(content), kind) + content

    fields = "uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;"
    parts = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)]
    parts.append(message(b"B", bytes(40)))
    parts.append(message(b"F", b"sensor_combined:" + fields.encode()))
    parts.append(message(b"A", struct.pack("<BH", 0, 0) + b"sensor_combined"))
    for row in range(N):
        values = struct.pack("<HQ6f", 0, 5000 * (row + 1), *GYRO[row], *ACCEL[row])
        parts.append(message(b"D", values))
    return b"".join(parts)
