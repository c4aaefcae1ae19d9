"""Readers of formats whose libraries are written in Python. Each returns a `Recording`.

| function | format | extra |
| --- | --- | --- |
| `ros` | bags of ROS 1 and ROS 2 | `pip install 'rins[ros]'` |
| `mcap` | MCAP with ROS 2 messages | `pip install 'rins[mcap]'` |
| `px4` | ULog of PX4 | `pip install 'rins[px4]'` |
| `hdf5` | HDF5, and MATLAB files of version 7.3 | `pip install 'rins[hdf5]'` |

The units of ROS and PX4 messages are those of their definitions. The axes are always stated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._errors import DataError
from ._recording import Recording

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["hdf5", "mcap", "px4", "ros"]

Axes = str | Sequence[str] | Mapping[str, str | Sequence[str]]

_RATES = {"gyro": "rad/s", "accel": "m/s^2"}


def ros(path: str | PathLike[str], topic: str, *, axes: Axes, **sections: Any) -> Recording:
    """Read the messages `sensor_msgs/Imu` of a bag of ROS 1 (``.bag``) or ROS 2 (a folder).

    Parameters
    ----------
    path : path-like
        The bag.
    topic : str
        The topic of the IMU.
    axes, **sections
        As of `Recording`: the axes and the sections of a rig file.

    Raises
    ------
    DataError
        If the bag has no such topic, or its messages are of another type.
    """
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    name = fspath(path)
    # Bags that state their own definitions use these; the others those of the last long-term release.
    store = get_typestore(Stores.ROS2_JAZZY)
    with AnyReader([Path(name)], default_typestore=store) as reader:
        connections = [one for one in reader.connections if one.topic == topic]
        _ensure_topic(name, topic, sorted({one.topic for one in reader.connections}))
        for one in connections:
            if one.msgtype != "sensor_msgs/msg/Imu":
                message = f"{name}: topic {topic!r} has {one.msgtype}, expected sensor_msgs/Imu"
                raise DataError(message, name, None, topic)
        messages = (
            reader.deserialize(raw, one.msgtype)
            for one, _, raw in reader.messages(connections=connections)
        )
        return _of_imu_messages(name, messages, axes, sections)


def mcap(path: str | PathLike[str], topic: str, *, axes: Axes, **sections: Any) -> Recording:
    """Read the messages `sensor_msgs/Imu` of an MCAP file with ROS 2 messages.

    Parameters
    ----------
    path : path-like
        The file.
    topic, axes, **sections
        As of `ros`.

    Raises
    ------
    DataError
        If the file has no such topic, or its messages are of another type.
    """
    from mcap.reader import make_reader
    from mcap_ros2.reader import read_ros2_messages

    name = fspath(path)
    with open(name, "rb") as file:
        summary = make_reader(file).get_summary()
    if summary is None:
        raise DataError(f"{name}: the file has no summary; is it complete?", name)
    _ensure_topic(name, topic, sorted({one.topic for one in summary.channels.values()}))
    for channel in summary.channels.values():
        schema = summary.schemas.get(channel.schema_id)
        kind = "no schema" if schema is None else schema.name
        if channel.topic == topic and kind != "sensor_msgs/msg/Imu":
            message = f"{name}: topic {topic!r} has {kind}, expected sensor_msgs/msg/Imu"
            raise DataError(message, name, None, topic)
    messages = (one.ros_msg for one in read_ros2_messages(name, topics=[topic]))
    return _of_imu_messages(name, messages, axes, sections)


def px4(path: str | PathLike[str], *, axes: Axes, instance: int = 0, **sections: Any) -> Recording:
    """Read the topic `sensor_combined` of a ULog file of PX4.

    Parameters
    ----------
    path : path-like
        The log.
    instance : int
        The instance of the topic.
    axes, **sections
        As of `Recording`.

    Raises
    ------
    DataError
        If the log has no such topic.
    """
    import numpy as np
    from pyulog import ULog

    name = fspath(path)
    topic = "sensor_combined"
    data = [one for one in ULog(name, [topic]).data_list if one.multi_id == instance]
    if not data:
        message = f"{name}: no topic {topic!r} with instance {instance}"
        raise DataError(message, name, None, topic)
    columns = data[0].data

    def triad(field: str) -> NDArray[np.float64]:
        return np.stack([columns[f"{field}[{axis}]"] for axis in range(3)], axis=1).astype(float)

    return Recording(
        columns["timestamp"],
        triad("gyro_rad"),
        triad("accelerometer_m_s2"),
        units={"t": "us", **_RATES},
        axes=axes,
        **{"name": name, **sections},
    )


def hdf5(
    path: str | PathLike[str],
    *,
    t: str,
    gyro: str,
    accel: str,
    units: Mapping[str, str],
    axes: Axes,
    table_angle: str | None = None,
    table_rate: str | None = None,
    temperature: str | None = None,
    transposed: bool = False,
    **sections: Any,
) -> Recording:
    """Read the datasets of an HDF5 file, or the variables of a MATLAB file of version 7.3.

    Parameters
    ----------
    path : path-like
        The file.
    t, gyro, accel, table_angle, table_rate, temperature : str
        The names of the datasets.
    transposed : bool
        Whether matrices are stored as (3, n), as by MATLAB.
    units, axes, **sections
        As of `Recording`.

    Raises
    ------
    DataError
        If a dataset does not exist.
    """
    import h5py
    import numpy as np

    name = fspath(path)
    wanted = {
        "t": t,
        "gyro": gyro,
        "accel": accel,
        "table_angle": table_angle,
        "table_rate": table_rate,
        "temperature": temperature,
    }
    arrays: dict[str, Any] = {}
    with h5py.File(name, "r") as file:
        for signal, key in wanted.items():
            if key is None:
                continue
            if not isinstance(file.get(key), h5py.Dataset):
                message = f"{name}: no dataset {key!r}; there are {sorted(file.keys())}"
                raise DataError(message, name, None, key)
            values = np.asarray(file[key])
            if signal not in ("gyro", "accel"):
                values = values.reshape(-1) if 1 in values.shape else values
            arrays[signal] = values.T if transposed else values
    return Recording(**arrays, units=units, axes=axes, **{"name": name, **sections})


def _ensure_topic(name: str, topic: str, topics: list[str]) -> None:
    if topic not in topics:
        message = f"{name}: no topic {topic!r}; the topics are {', '.join(topics)}"
        raise DataError(message, name, None, topic)


def _of_imu_messages(
    name: str, messages: Iterable[Any], axes: Axes, sections: Mapping[str, Any]
) -> Recording:
    """The recording of messages `sensor_msgs/Imu`, with their own time stamps."""
    import numpy as np

    stamps: list[int] = []
    rows: list[tuple[float, ...]] = []
    for one in messages:
        stamp, rate, force = one.header.stamp, one.angular_velocity, one.linear_acceleration
        stamps.append(stamp.sec * 1_000_000_000 + stamp.nanosec)
        rows.append((rate.x, rate.y, rate.z, force.x, force.y, force.z))
    values = np.array(rows, dtype=np.float64).reshape(-1, 6)
    return Recording(
        np.array(stamps, dtype=np.int64),
        values[:, :3],
        values[:, 3:],
        units={"t": "ns", **_RATES},
        axes=axes,
        **{"name": name, **sections},
    )
