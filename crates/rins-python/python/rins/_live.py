"""Calibration while a log is written."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING

from . import _rins
from ._result import LiveResult

if TYPE_CHECKING:
    from . import schema

    _Pathlike = str | PathLike[str]


class LiveCalibration:
    """Calibrate an IMU while its log is written: bytes in, estimates out.

    It is ``rins calibrate --live`` for a program that has the data itself, such as the reader of a serial port.

    Parameters
    ----------
    rig : path-like
        The rig file. Its log is not opened; it states the columns, units and axes of the bytes.
    model : str or path-like
        ``"full"``, or a model file.
    duration : float, optional
        The expected duration of the run [s]: epochs are then those of a finished run of this duration; by default 0.1 s.
    start : float
        The duration of the samples from which the attitude of the axis is found [s].
    source : path-like, optional
        What messages name as the source of the bytes; by default the log of the rig file.
    resume : path-like, optional
        A checkpoint, from which the calibration continues. Rows up to its time are passed over.

    Raises
    ------
    DataError
        If the rig file has an error or cannot be used live, or the checkpoint belongs to another rig file or model.
    ModelError
        If the model file has an error.

    Examples
    --------
    >>> live = rins.LiveCalibration("rig.toml")  # doctest: +SKIP
    >>> for line in port:  # doctest: +SKIP
    ...     live.feed(line)
    ...     print(live.line())
    >>> res = live.end()  # doctest: +SKIP
    """

    _live: _rins.LiveCalibration

    def __init__(
        self,
        rig: _Pathlike,
        model: _Pathlike = "full",
        *,
        duration: float | None = None,
        start: float = 10.0,
        source: _Pathlike | None = None,
        resume: _Pathlike | None = None,
    ) -> None:
        options: _rins._Live = {
            "model": fspath(model),
            "duration": duration,
            "start": start,
            "source": None if source is None else fspath(source),
            "checkpoint": None if resume is None else fspath(resume),
        }
        self._live = _rins.LiveCalibration(fspath(rig), options)

    def feed(self, data: bytes) -> int:
        """Take the next bytes of the log, in portions of any length.

        Parameters
        ----------
        data : bytes
            They continue those of the last call. A row counts once its line end is there. The first row is the head, if the log of
            the rig file has one.

        Returns
        -------
        int
            The number of samples that they complete.

        Raises
        ------
        DataError
            If a row cannot be read; the rows before it have been processed. If units, signs or axes are wrong.
        """
        return self._live.feed(data)

    @property
    def time(self) -> float | None:
        """The time of the last epoch [s]; None as long as the samples at the start are incomplete."""
        return self._live.time

    @property
    def parameters(self) -> list[schema.LiveParameterResult] | None:
        """The estimates so far; None as long as the samples at the start are incomplete."""
        parameters = self._live.parameters
        if parameters is None:
            return None
        return [
            {
                "id": name,
                "value": value,
                "sigma": sigma,
                "unit": unit,
                "prior_sigma": prior_sigma,
                "identified": identified,
            }
            for name, value, sigma, unit, prior_sigma, identified in parameters
        ]

    def line(self) -> str:
        """The state in a line, as the command shows it."""
        return self._live.line()

    def write_checkpoint(self, path: _Pathlike) -> bool:
        """Write the state to a file, whole or not at all.

        Returns
        -------
        bool
            Whether there is a state: as long as the samples at the start are incomplete, nothing is written.

        Raises
        ------
        DataError
            If the file cannot be written.
        """
        return self._live.write_checkpoint(fspath(path))

    def end(self) -> LiveResult:
        """End the calibration with the rows that are there; further calls are errors.

        Returns
        -------
        LiveResult
            As of ``rins calibrate --live``.

        Raises
        ------
        DataError
            If there are too few rows.
        """
        return LiveResult(self._live.end())
