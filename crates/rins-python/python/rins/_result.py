"""Results of commands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from . import _rins
from ._table import Table

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from . import schema
    from ._recording import Recording

    _Floats = NDArray[np.float64]

D = TypeVar("D", bound=Mapping[str, Any])


# The typed dicts are imported by type checkers only: there are many.
class Result(Mapping[str, Any], Generic[D]):
    """The result of a command.

    It is a mapping: ``res["parameters"][0]["value"]``. `data` is the same as a typed dict, whose keys `rins.schema` documents.

    Attributes
    ----------
    failure : str or None
        The defect of the data, if there is one in spite of the result; the command then ends with exit code 1.
    """

    _outcome: _rins.Outcome
    _data: D | None

    def __init__(self, outcome: _rins.Outcome) -> None:
        self._outcome = outcome
        self._data = None

    @property
    def data(self) -> D:
        """The typed fields of the result; the dict is shared, not copied."""
        if self._data is None:
            import json

            self._data = cast(D, json.loads(self._outcome.json))
        return self._data

    @property
    def failure(self) -> str | None:
        return self._outcome.failure

    def __getitem__(self, key: str) -> Any:
        return self.data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self.data)

    def __len__(self) -> int:
        return len(self.data)

    def summary(self) -> str:
        """The text that the command prints."""
        return self._outcome.text

    def to_json(self) -> str:
        """The line that the command prints with ``--json``, without its line feed."""
        return self._outcome.json

    def page(self) -> str | None:
        """The report: one HTML page that works offline; None of commands without one."""
        return self._outcome.page()

    def write(self, folder: str | PathLike[str], *, force: bool = False) -> Path | None:
        """Write the folder that the command writes with ``-o``: ``result.json``, ``report.html`` and further files, all or none.

        Parameters
        ----------
        folder : path-like
            The folder.
        force : bool
            Whether an existing folder of results is replaced.

        Returns
        -------
        Path or None
            The report page, if there is one.

        Raises
        ------
        DataError
            If the folder exists and must not be replaced, or cannot be written.
        """
        page = self._outcome.write(fspath(folder), force)
        return None if page is None else Path(page)

    _rows: str | None = None
    """The key of the list that `to_arrow` takes by default."""

    def to_arrow(self, key: str | None = None) -> Table:
        """A list of the result as an Arrow table, one row for each item.

        Parameters
        ----------
        key : str, optional
            The key of the list; by default the main one of the command, such as ``"parameters"`` of `calibrate`.

        Raises
        ------
        KeyError
            If the result has no such list.

        Notes
        -----
        Columns are the fields with a text, a number or a flag; nested fields are left out.
        """
        key = key or self._rows
        rows = None if key is None else self.data.get(key)
        if not isinstance(rows, list):
            lists = [name for name, one in self.data.items() if isinstance(one, list)]
            raise KeyError(f"{key!r}: expected the key of a list, one of {lists}")
        return _table(cast("Sequence[object]", rows))

    def _repr_html_(self) -> str:
        rows = self.data.get(self._rows) if self._rows is not None else None
        text = f"<pre>{escape(self.summary())}</pre>"
        return text + _html_rows(cast("Sequence[object]", rows)) if rows else text

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of rins {self.data.get('command', '')}: {', '.join(self)}>"


_SCALARS = (str, int, float, bool, type(None))


def _fields(rows: Sequence[object]) -> dict[str, list[Any]]:
    """The fields of rows that are scalars in all of them."""
    dicts = [row if isinstance(row, dict) else {"value": row} for row in rows]
    names = list(dict.fromkeys(name for row in dicts for name in row))
    columns = {name: [row.get(name) for row in dicts] for name in names}
    return {
        name: column
        for name, column in columns.items()
        if all(isinstance(one, _SCALARS) for one in column)
    }


def _table(rows: Sequence[object]) -> Table:
    columns: list[tuple[str, Sequence[object]]] = []
    for name, column in _fields(rows).items():
        is_number = any(isinstance(one, float) for one in column)
        columns.append((name, [float(x) if is_number and x is not None else x for x in column]))
    return Table(_rins.table(columns))


def _html_rows(rows: Sequence[object]) -> str:
    fields = {name: one for name, one in _fields(rows).items() if any(x is not None for x in one)}

    def cell(value: object) -> str:
        text = f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
        return f"<td>{escape(text)}</td>"

    head = "".join(f"<th>{escape(name)}</th>" for name in fields)
    body = "".join("<tr>" + "".join(map(cell, row)) + "</tr>" for row in zip(*fields.values()))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class EstimateResult(Result[D]):
    """Estimates of n parameters with their covariance."""

    _rows = "parameters"
    _identified = "identifiable"
    """The field of a parameter that states whether the data determine it."""

    @property
    def identified(self) -> NDArray[np.bool_]:
        """Whether the data determine each parameter, shape (n,)."""
        import numpy as np

        return np.array([one[self._identified] for one in self.data["parameters"]], dtype=np.bool_)

    @property
    def names(self) -> list[str]:
        """The ids of the parameters, n; of a parameter that belongs to one run with ``@run``."""
        return [
            one["id"] if one.get("run") is None else f"{one['id']}@{one['run']}"
            for one in self.data["parameters"]
        ]

    @property
    def units(self) -> list[str]:
        """The units of the parameters, n."""
        return [one["unit"] for one in self.data["parameters"]]

    @property
    def x(self) -> _Floats:
        """The estimates, shape (n,), in `units`."""
        import numpy as np

        return np.array([one["value"] for one in self.data["parameters"]], dtype=np.float64)

    @property
    def se(self) -> _Floats:
        """The standard uncertainties (1 sigma), shape (n,), in `units`."""
        import numpy as np

        return np.array([one["sigma"] for one in self.data["parameters"]], dtype=np.float64)

    @property
    def correlation(self) -> _Floats:
        """The correlation matrix, shape (n, n)."""
        import numpy as np

        return np.array(self.data["correlation"], dtype=np.float64)

    @property
    def cov(self) -> _Floats:
        """The covariance matrix, shape (n, n), in products of `units`: the correlation times the standard uncertainties."""
        import numpy as np

        return self.correlation * np.outer(self.se, self.se)

    def plot(self, ax: Axes | None = None, *, unit: str | None = None) -> Axes:
        """Draw the estimates of one unit with their 3 sigma bars; see `rins.plot.parameters`."""
        from .plot import parameters

        return parameters(self, ax, unit=unit)


class CalibrateResult(EstimateResult["schema.CalibrateResult"]):
    """The result of `rins.calibrate`: estimates with their covariance.

    A parameter that the data show only in a combination has the value and the uncertainty of the combination: its
    `identified` is false, and ``aliases`` names the others.
    """


class LiveResult(EstimateResult["schema.LiveResult"]):
    """The result of `rins.LiveCalibration`: estimates with their covariance.

    A parameter that is not `identified` by the samples has a value close to what was known beforehand.
    """

    _identified = "identified"


class DiagnoseResult(Result["schema.DiagnoseResult"]):
    """The result of `rins.diagnose`: the causes with their p-values, and what is unexplained."""

    _rows = "causes"

    @property
    def verdict(self) -> str:
        """``adequate``, ``named``, ``ambiguous`` or ``unexplained``."""
        return self.data["verdict"]

    @property
    def causes(self) -> list[schema.CauseResult]:
        """The effects, in order of evidence."""
        return self.data["causes"]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the evidence of the causes; see `rins.plot.causes`."""
        from .plot import causes

        return causes(self, ax)


class AllanResult(Result["schema.AllanResult"]):
    """The result of `rins.allan`: Allan deviations with confidence bounds and noise terms."""

    _rows = "channels"

    def plot(self, ax: Axes | None = None, *, sensor: str = "gyro") -> Axes:
        """Draw the Allan deviations of the gyros or accelerometers; see `rins.plot.allan`."""
        from .plot import allan

        return allan(self, ax, sensor=sensor)


class ObserveResult(Result["schema.ObserveResult"]):
    """The result of `rins.observe`: what a rotation schedule shows, and the schedule to run next."""

    _rows = "schedules"

    def to_arrow(self, key: str | None = None) -> Table:
        """The parameters of all schedules as an Arrow table, with the column ``schedule``; or another list."""
        if key is not None:
            return super().to_arrow(key)
        return _table(
            [
                {"schedule": schedule["name"], **one}
                for schedule in self.data["schedules"]
                for one in schedule["parameters"]
            ]
        )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the predicted uncertainties against those before the run; see `rins.plot.observability`."""
        from .plot import observability

        return observability(self, ax)


class MissionResult(Result["schema.MissionResult"]):
    """The result of `rins.mission`: position errors after days in service."""

    _rows = "schemes"

    def plot(self, ax: Axes | None = None, *, measure: str | None = None) -> Axes:
        """Draw the position error of each scheme; see `rins.plot.mission`."""
        from .plot import mission

        return mission(self, ax, measure=measure)


class NavigateResult(Result["schema.NavigateResult"]):
    """The result of `rins.navigate`: the errors of free inertial navigation."""

    _rows = "runs"


class InitResult(Result["schema.InitResult"]):
    """The result of `rins.init`: a drafted rig file, with guesses to be confirmed."""

    _rows = "guesses"

    @property
    def text(self) -> str:
        """The drafted rig file."""
        return self.data["rig"]


class SimulateResult(Result["schema.SimulateResult"]):
    """The result of `rins.simulate`: a simulated data set."""

    def recording(self) -> Recording:
        """The simulated data set as a recording, read as a log is."""
        from tempfile import TemporaryDirectory

        from ._recording import Recording

        with TemporaryDirectory() as folder:
            self.write(Path(folder) / "run")
            return Recording.open(Path(folder) / "run" / "rig.toml")
