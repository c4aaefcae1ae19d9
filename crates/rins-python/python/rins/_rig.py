"""Rig files."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, TypedDict, Unpack, cast

from . import _rins, _toml

if TYPE_CHECKING:
    from ._recording import Recording

Section = Mapping[str, object]
"""A section of a rig file: keys and quantities with their units, as ``{"latitude": "34.25 deg"}``."""


class Sections(TypedDict, total=False):
    """The sections of a rig file, each optional; None is as if it was not given."""

    site: Section | None
    log: Section | None
    attitude: Section | None
    imu: Section | None
    table: Section | None
    axis: Section | None
    tolerance: Section | None
    run: Section | None
    lab: Section | None


class Rig:
    """The description of a measurement: site, log, table and data sheets.

    The arguments are the sections of a rig file (see *Logs and their formats* in the book). Quantities are texts with units.

    Parameters
    ----------
    site, log, attitude, imu, table, axis, tolerance, run, lab : mapping, optional
        The sections.
    path : str
        The name of the rig in messages, and the folder of files that it names.

    Raises
    ------
    DataError
        If a key is unknown, missing, of the wrong dimension or out of range.

    Examples
    --------
    >>> rig = Rig(
    ...     site={"latitude": "34.25 deg", "height": "400 m"},
    ...     log={
    ...         "path": "arrays",
    ...         "format": "csv",
    ...         "time": {"column": "t", "unit": "s"},
    ...         "gyro": {"columns": ["gx", "gy", "gz"], "unit": "deg/h"},
    ...         "accel": {"columns": ["ax", "ay", "az"], "unit": "mg"},
    ...     },
    ... )
    >>> rig.sections["site"]["height"]
    '400 m'
    """

    _text: str
    _path: str

    def __init__(self, *, path: str = "rig", **sections: Unpack[Sections]) -> None:
        for name in sections:
            if name not in Sections.__annotations__:
                known = ", ".join(Sections.__annotations__)
                raise TypeError(f"{name!r} is no section of a rig file, expected one of {known}")
        given = {name: cast(Section, one) for name, one in sections.items() if one is not None}
        self._set(_toml.document(given), path)

    @classmethod
    def parse(cls, text: str, path: str = "rig") -> Rig:
        """The rig in `text`, the content of a rig file.

        Raises
        ------
        DataError
            With the line and the key of the error.
        """
        rig = cls.__new__(cls)
        rig._set(text, path)
        return rig

    def _set(self, text: str, path: str) -> None:
        _rins.check_rig(text, path)
        self._text, self._path = text, path

    @property
    def text(self) -> str:
        """The content of the rig file."""
        return self._text

    @property
    def path(self) -> str:
        """The path of the rig file, or the name of the rig."""
        return self._path

    @property
    def sections(self) -> dict[str, Any]:
        """The sections as a new dict."""
        import tomllib

        return tomllib.loads(self._text)

    def load(self) -> Recording:
        """Read the log that a rig file names.

        Raises
        ------
        DataError
            If the rig was not read from a file, or the log cannot be read or is invalid.
        """
        from ._recording import Recording

        return Recording.open(self._path)

    def __repr__(self) -> str:
        return f"Rig({self._path!r})"


def read_rig(path: str | PathLike[str]) -> Rig:
    """Read a rig file and check it; the log is not read.

    Parameters
    ----------
    path : path-like
        The rig file.

    Raises
    ------
    DataError
        If the file cannot be read, or a key is missing, unknown, of the wrong dimension or out of range.
    """
    from ._errors import DataError

    name = fspath(path)
    try:
        with open(name, encoding="utf-8") as file:
            text = file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"cannot read {name}: {error}", name) from error
    return Rig.parse(text, name)
