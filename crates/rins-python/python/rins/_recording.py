"""Recordings: logs in memory."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Unpack

from . import _rins
from ._errors import DataError
from ._rig import Rig, Sections, read_rig
from ._table import Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    _Floats = NDArray[np.float64]

_EXPECTED = {
    "t": '"s", "ms", "us" or "ns"',
    "gyro": '"rad/s", "deg/s" or "deg/h" for rates, "rad", "deg" or "arcsec" for increments',
    "accel": '"m/s^2", "g", "mg" or "ug" for specific force, "m/s" or "ug*s" for increments',
    "table_angle": '"rad", "deg" or "arcsec"',
    "table_rate": '"rad/s", "deg/s" or "deg/h"',
    "temperature": '"degC" or "K"',
}

_AXES = 'for body x, y and z the axis of the sensor along it, such as "xyz" or ["-y", "x", "z"]'


class Recording:
    """The log of an IMU on a rate table, with its rig.

    It is made of arrays, read from a rig file (`Recording.open`), or made of a data frame (`Recording.from_table`). Units and axes
    are stated; nothing is guessed. The columns get the checks of a log file: gaps, repeated and damaged rows, stuck channels,
    plausible numbers.

    Parameters
    ----------
    t : array_like, shape (n,)
        Time stamps, at the end of each sample's interval (or as `stamp` states).
    gyro : array_like, shape (n, 3)
        Angular rates or angle increments.
    accel : array_like, shape (n, 3)
        Specific forces or velocity increments.
    table_angle, table_rate, temperature : array_like, shape (n,), optional
        The angle of the table, which may wrap; its mean rate over each interval; the temperature of the IMU.
    units : mapping
        The unit of each given array, by the name of its argument. The unit states whether numbers are rates or increments.
    axes : str, sequence of str, or mapping
        For body x, y and z the axis of the sensor (column x, y or z) that is along it: ``"xyz"``, ``["-y", "x", "z"]``, or one
        for each sensor: ``{"gyro": "xyz", "accel": ["x", "-y", "-z"]}``.
    stamp : {"end", "start", "middle"}
        The instant of a sample's interval that `t` refers to.
    site, attitude, imu, table, axis, tolerance, run, lab : mapping, optional
        Sections of a rig file.
    log : mapping, optional
        Further keys of ``[log]``, such as ``{"rate": "100 Hz", "table_angle": {"noise": "0.3 arcsec"}}``.
    name : str
        The name of the recording in messages and in the provenance of results.

    Raises
    ------
    DataError
        If a unit or the axes are missing, arrays differ in length, or the data are invalid.

    Notes
    -----
    Arrays of float64 and int64 are read where they lie, whatever their strides, without a copy in Python; the recording holds
    increments, which are computed from them. Integer time stamps keep all their digits.
    """

    _log: _rins.Log
    _rig: Rig

    def __init__(
        self,
        t: ArrayLike,
        gyro: ArrayLike,
        accel: ArrayLike,
        *,
        units: Mapping[str, str],
        axes: str | Sequence[str] | Mapping[str, str | Sequence[str]] | None = None,
        table_angle: ArrayLike | None = None,
        table_rate: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        stamp: str = "end",
        name: str = "arrays",
        **sections: Unpack[Sections],
    ) -> None:
        signals = {
            "t": t,
            "gyro": gyro,
            "accel": accel,
            "table_angle": table_angle,
            "table_rate": table_rate,
            "temperature": temperature,
        }
        given = {key: one for key, one in signals.items() if one is not None}
        _ensure_stated(given, units, name)
        along = {sensor: _axes_of(axes, sensor, name) for sensor in ("gyro", "accel")}
        columns: list[tuple[str, Any]] = []
        # The format is that of columns with names; no file is read.
        keys: dict[str, object] = {"path": name, "format": "csv"}
        for signal, array in given.items():
            own = {"unit": units[signal]}
            names = _columns(signal, array, columns, name)
            if signal in along:
                keys[signal] = {"columns": names, **own, "axes": along[signal]}
            elif signal == "t":
                keys["time"] = {"column": names[0], **own, "stamp": stamp}
            else:
                keys[signal] = {"column": names[0], **own}
        for key, further in (sections.get("log") or {}).items():
            stated = keys.get(key)
            if isinstance(stated, dict) and isinstance(further, Mapping):
                keys[key] = {**stated, **further}
            else:
                keys[key] = further
        sections["log"] = keys
        self._rig = Rig(path=name, **sections)
        self._log = _rins.Log.of_arrays((self._rig.text, name), name, columns)

    @classmethod
    def open(cls, path: str | PathLike[str]) -> Recording:
        """Read a rig file and the log that it names.

        Raises
        ------
        DataError
            With file, line and key.
        """
        name = fspath(path)
        return cls._of(_rins.Log.open(name, False), read_rig(name))

    @classmethod
    def from_table(
        cls, data: object, rig: Rig | str | PathLike[str], *, name: str = "table"
    ) -> Recording:
        """Make a recording of a data frame or an Arrow table.

        Parameters
        ----------
        data : object with ``__arrow_c_stream__``
            A polars or pandas DataFrame, a pyarrow Table, a DuckDB relation, …; columns that ``[log]`` does not name are ignored.
            Time stamps of Arrow (datetime) are nanoseconds since 1970: ``unit = "ns"``.
        rig : Rig or path-like
            The rig, whose ``[log]`` states the names, units and axes of the columns.
        name : str
            The name of the data in messages and in the provenance of results.

        Raises
        ------
        DataError
            If a column is missing or has no numbers, or the data are invalid.
        """
        if not hasattr(data, "__arrow_c_stream__"):
            kind = type(data).__name__
            raise TypeError(
                f"data: {kind} has no __arrow_c_stream__; for arrays use Recording(...)"
            )
        rig = rig if isinstance(rig, Rig) else read_rig(rig)
        return cls._of(_rins.Log.of_stream((rig.text, rig.path), name, data), rig)

    @classmethod
    def _of(cls, log: _rins.Log, rig: Rig) -> Recording:
        recording = cls.__new__(cls)
        recording._log, recording._rig = log, rig
        return recording

    def compensated(
        self, calibration: str | PathLike[str], *, extrapolate: bool = False
    ) -> Recording:
        """The recording compensated with a calibration, as `rins.apply` writes it.

        Parameters
        ----------
        calibration : path-like
            The calibration file.
        extrapolate : bool
            Whether readings are compensated far outside the calibrated range of temperature.

        Raises
        ------
        DataError
            If units, signs or axes are wrong, or the calibration is of another IMU or does not cover the recording.

        Warns
        -----
        UserWarning
            If temperature, rate or date lie outside of what was calibrated.
        """
        log, notes = self._log.compensated(fspath(calibration), extrapolate)
        for note in notes:
            warnings.warn(note, stacklevel=2)
        return self._of(log, self._rig)

    @property
    def rig(self) -> Rig:
        """The rig."""
        return self._rig

    @property
    def name(self) -> str:
        """The name: the path of the rig file, or the name that was given."""
        return self._log.name

    @property
    def repairs(self) -> list[str]:
        """The repairs and omissions made while reading, one sentence each."""
        return self._log.repairs

    @property
    def inputs(self) -> list[tuple[str, str]]:
        """The inputs: path or name, and SHA-256."""
        return self._log.inputs

    def _signal(self, name: str) -> _Floats | None:
        import numpy as np

        for signal, components, memory in self._log.memory():
            if signal == name:
                values = np.frombuffer(memory, dtype=np.float64)
                return values if components == 1 else values.reshape(components, -1).T
        return None

    def _required(self, name: str) -> _Floats:
        values = self._signal(name)
        assert values is not None, "every recording has it"
        return values

    @property
    def t(self) -> _Floats:
        """The end of each sample's interval [s], shape (n,), read-only; a view of the recording's memory, as all arrays here."""
        return self._required("t")

    @property
    def gyro(self) -> _Floats:
        """The mean angular rates over each interval [rad/s], shape (n, 3), along the body axes with z along the spin axis."""
        return self._required("gyro")

    @property
    def accel(self) -> _Floats:
        """The mean specific forces over each interval [m/s^2], shape (n, 3), along the same axes."""
        return self._required("accel")

    @property
    def table_angle(self) -> _Floats | None:
        """The table angle at the end of each interval [rad], unwrapped, shape (n,); None without one."""
        return self._signal("table_angle")

    @property
    def table_rate(self) -> _Floats | None:
        """The mean table rate over each interval [rad/s], shape (n,); None without one."""
        return self._signal("table_rate")

    @property
    def temperature(self) -> _Floats | None:
        """The temperature at the end of each interval [degC], shape (n,); None without one."""
        return self._signal("temperature")

    def to_arrow(self) -> Table:
        """The recording as an Arrow table that shares its memory: t, gyro_x, … in s, rad/s, m/s^2, rad, degC."""
        return Table(self._log.table())

    def __len__(self) -> int:
        return len(self._log)

    def __repr__(self) -> str:
        return f"Recording({self.name!r}, {len(self)} samples)"


def _ensure_stated(given: Mapping[str, object], units: Mapping[str, str], name: str) -> None:
    for signal in given:
        if signal not in units:
            message = f"{name}: units[{signal!r}]: missing, expected {_EXPECTED[signal]}"
            raise DataError(message, name, None, f"units[{signal!r}]")
    for unit in units:
        if unit not in given:
            known = ", ".join(repr(one) for one in given)
            message = f"{name}: units[{unit!r}]: there is no such array, expected one of {known}"
            raise DataError(message, name, None, f"units[{unit!r}]")


def _axes_of(
    axes: str | Sequence[str] | Mapping[str, str | Sequence[str]] | None, sensor: str, name: str
) -> list[str]:
    own = axes.get(sensor) if isinstance(axes, Mapping) else axes
    if own is None:
        key = f"axes[{sensor!r}]" if axes is not None else "axes"
        raise DataError(f"{name}: {key}: missing, expected {_AXES}", name, None, key)
    return list(own)


def _columns(signal: str, array: ArrayLike, columns: list[tuple[str, Any]], name: str) -> list[str]:
    """Append the columns of an array; their names."""
    import numpy as np

    values = np.asarray(array)
    triad = signal in ("gyro", "accel")
    if values.ndim != (2 if triad else 1) or (triad and values.shape[1] != 3):
        expected = "(n, 3)" if triad else "(n,)"
        message = f"{name}: {signal}: the shape is {values.shape}, expected {expected}"
        raise DataError(message, name, None, signal)
    if values.dtype.kind == "M":
        values = values.astype("datetime64[ns]").view(np.int64)
    elif values.dtype.kind in "iu":
        values = values.astype(np.int64, copy=False)
    elif values.dtype.kind == "f":
        values = values.astype(np.float64, copy=False)
    else:
        message = f"{name}: {signal}: the type is {values.dtype}, expected numbers"
        raise DataError(message, name, None, signal)
    if not triad:
        columns.append((signal, values))
        return [signal]
    names = [f"{signal}_{axis}" for axis in "xyz"]
    columns.extend((one, values[:, axis]) for axis, one in enumerate(names))
    return names


def log_of(run: Recording | str | PathLike[str], partial: bool = False) -> _rins.Log:
    """The log of a run, which is read if it is a rig file."""
    if isinstance(run, Recording):
        return run._log
    return _rins.Log.open(fspath(run), partial)
