"""Arrow tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as _pandas
    import polars as _polars
    import pyarrow as _pyarrow

    from ._rins import _ArrowStream


class Table:
    """A table in Arrow's format, which other libraries take without a copy.

    It has `__arrow_c_stream__` (the Arrow PyCapsule interface): ``pyarrow.table(t)``, ``polars.DataFrame(t)`` and
    ``duckdb.from_arrow(t)`` share its memory.
    """

    _stream: _ArrowStream

    def __init__(self, stream: _ArrowStream) -> None:
        self._stream = stream

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self._stream.__arrow_c_stream__(requested_schema)

    @property
    def column_names(self) -> list[str]:
        """The names of the columns."""
        return list(self._stream.column_names)

    @property
    def num_rows(self) -> int:
        """The number of rows."""
        return self._stream.num_rows

    def __len__(self) -> int:
        return self.num_rows

    def to_pyarrow(self) -> _pyarrow.Table:
        """The table as a `pyarrow.Table`, without a copy."""
        import pyarrow

        return pyarrow.table(self)

    def to_polars(self) -> _polars.DataFrame:
        """The table as a `polars.DataFrame`, without a copy of numbers."""
        import polars

        return polars.DataFrame(self)

    def to_pandas(self) -> _pandas.DataFrame:
        """The table as a `pandas.DataFrame`; it needs pyarrow."""
        frame: _pandas.DataFrame = self.to_pyarrow().to_pandas()
        return frame

    def to_frame(self) -> Any:
        """A DataFrame of the library that is installed: polars, otherwise pandas.

        Raises
        ------
        ImportError
            If neither is installed.
        """
        try:
            return self.to_polars()
        except ImportError:
            return self.to_pandas()

    def __repr__(self) -> str:
        return f"Table({self.num_rows} rows: {', '.join(self.column_names)})"
