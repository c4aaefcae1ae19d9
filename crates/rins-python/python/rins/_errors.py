"""Exceptions."""

from __future__ import annotations


class RinsError(Exception):
    """An error in data, files or a model.

    Attributes
    ----------
    file : str or None
        The file with the error, or the name of data in memory.
    line : int or None
        The line in that file, from 1; of data in memory the row.
    key : str or None
        The section and key, as in ``[imu.gyro] noise``, the column of a log, or the argument.
    """

    file: str | None
    line: int | None
    key: str | None

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        key: str | None = None,
    ) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.key = key

    def __reduce__(self) -> tuple[type[RinsError], tuple[object, ...]]:
        return type(self), (*self.args, self.file, self.line, self.key)


class DataError(RinsError):
    """The data or the files are at fault: the cases of exit code 1 of the command."""


class ModelError(RinsError):
    """A model file is invalid, or the model cannot be estimated from the data."""
