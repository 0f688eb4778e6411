"""Tables of mfv_sweep: one row a case."""

from __future__ import annotations

import csv
import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _html
from .errors import NotAResult
from .result import open_hdf5, values_of

if TYPE_CHECKING:
    import pandas


class Table(np.ndarray):
    """A structured array, one row a case; texts are str. `table["stick_ratio"]` is a column, a plain array; `table[3]` a row,
    `table[table["outcome"] == "complete"]` a table of some rows, `pandas.DataFrame(table)` a data frame.

    `units` and `long_names` have the unit and the meaning of every column; `attributes` those of the file: the texts of the
    sweep and its base cases, whether it is complete, how many cases ended how.
    """

    units: dict[str, str]
    long_names: dict[str, str]
    attributes: dict[str, Any]

    def __array_finalize__(self, source: Any) -> None:
        for name in ("units", "long_names", "attributes"):
            setattr(self, name, getattr(source, name, {}))

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        return np.asarray(found) if isinstance(key, str) else found

    def __reduce__(self) -> tuple[Any, ...]:
        function, arguments, state = tuple(super().__reduce__())
        return function, arguments, (state, self.units, self.long_names, self.attributes)

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        of_array, self.units, self.long_names, self.attributes = state
        super().__setstate__(of_array)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return self.dtype.names or ()

    def describe(self) -> str:
        """The columns in words: name, values, unit, meaning."""
        lines = [f"  {name:28}{values:34}{unit:16}{meaning}" for name, values, unit, meaning in self._words()]
        return "\n".join([f"{self.size} cases", *lines])

    def _repr_html_(self) -> str:
        return _html.table(self._words(), f"{self.size} cases")

    def _words(self) -> list[tuple[str, str, str, str]]:
        """Of every column name, values, unit and meaning."""
        return [
            (name, _values(self[name]), _html.unit(self.units[name]), self.long_names[name])
            for name in self.columns
        ]

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a data frame; its `attrs` have the units and the meanings of the columns. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(np.asarray(self))
        frame.attrs = {"units": self.units, "long_names": self.long_names}
        return frame

    def write_csv(self, path: str | os.PathLike[str] | None) -> None:
        """Write the table as comma-separated values, with a line of names; None: to the standard output."""
        if path is None:
            self._write_rows(sys.stdout)
            return
        with open(path, "w", newline="", encoding="utf-8") as file:
            self._write_rows(file)

    def _write_rows(self, file: Any) -> None:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(np.asarray(self).tolist())


def read_table(path: str | os.PathLike[str]) -> Table:
    """The table in a file of mfv_sweep. Raises OSError, NotAResult."""
    path = os.fspath(path)
    with open_hdf5(path, "table of mfv_sweep") as file:
        if "table" not in file or "input_checksum" not in file.attrs:
            raise NotAResult(None, f"{path}: not a table of mfv_sweep, though it is HDF5")
        dataset = file["table"]
        table = _with_text(values_of(dataset)).view(Table)
        names = [str(name) for name in dataset.attrs["columns"]]
        table.units = dict(zip(names, map(str, dataset.attrs["units"])))
        table.long_names = dict(zip(names, map(str, dataset.attrs["long_names"])))
        table.attributes = {
            name: value if isinstance(value, str) else int(value) for name, value in file.attrs.items()
        }
    return table


def _with_text(rows: np.ndarray) -> np.ndarray:
    """The same with str in place of bytes."""
    columns = {
        name: np.char.decode(rows[name], "utf-8") if rows.dtype[name].kind == "S" else rows[name]
        for name in rows.dtype.names or ()
    }
    text = np.empty(rows.shape, np.dtype([(name, column.dtype) for name, column in columns.items()]))
    for name, column in columns.items():
        text[name] = column
    return text


def _values(column: np.ndarray) -> str:
    """What a column holds: a few texts, or from where to where its numbers go."""
    if column.dtype.kind == "U":
        different = sorted(set(column.tolist()))
        return different[0][:32] if len(different) == 1 else f"{len(different)} different"
    finite = column[np.isfinite(column)]
    if finite.size == 0:
        return "none"
    missing = column.size - finite.size
    return f"{finite.min():.6g} to {finite.max():.6g}" + (f", {missing} none" if missing else "")
