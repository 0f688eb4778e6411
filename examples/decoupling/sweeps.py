"""The parameter studies that chapter 6 consists of, and their tables."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from mfv.studies.dataset import frame_of
from mfv.studies.namelist import read_study

HERE = Path(__file__).resolve().parent
NAMES = (
    "cyclic",
    "lateral_force",
    "friction",
    "ratios",
    "mindlin",
    "small_force",
    "mismatch",
    "map",
    "map_fine",
    "shakedown",
    "threshold",
    "shapes",
    "laws",
)
COUPLINGS = {"full": "full coupling", "goodman": "Goodman", "none": "decoupled"}

#: Limits of a quick study: number of values of an axis, and nodes of a mesh; other cases have COARSE.
FEW, OTHERWISE, LARGEST, COARSE = 4, {"small_force": 9, "laws": 1}, 195, 97


class Table:
    """Rows of a study's table: columns by name, rows by values."""

    def __init__(self, rows: np.ndarray) -> None:
        self.rows = rows

    def __getitem__(self, column: str) -> np.ndarray:
        return self.rows[column]

    def __len__(self) -> int:
        return len(self.rows)

    def where(self, **values: Any) -> Table:
        """The rows that have these values, numbers to within round-off."""
        keep = np.ones(len(self.rows), dtype=bool)
        for column, value in values.items():
            entries = self.rows[column]
            keep &= np.isclose(entries, value, rtol=1e-9, atol=1e-12) if entries.dtype.kind in "if" else entries == value
        return Table(self.rows[keep])

    def between(self, column: str, low: float, high: float) -> Table:
        """The rows with a number from `low` to `high`."""
        entries = self.rows[column]
        return Table(self.rows[(entries >= low - 1e-12) & (entries <= high + 1e-12)])

    def values(self, column: str) -> list[Any]:
        """The different values of a column, in the order of the rows."""
        return list(dict.fromkeys(self.rows[column].tolist()))

    def each(self, column: str) -> Iterator[tuple[Any, Table]]:
        """The rows by the values of a column."""
        for value in self.values(column):
            yield value, self.where(**{column: value})

    def columns(self, names: list[str]) -> dict[str, np.ndarray]:
        """Some columns, for a file of numbers."""
        return {name: self.rows[name] for name in names}


def mean_of(table: Table, column: str) -> float:
    """Mean of a column."""
    return float(table[column].mean())


def run(name: str, folder: Path, quick: bool) -> Table:
    """The table of a study; cases already solved in `folder` are reused. Raises RuntimeError if one ends early."""
    text = HERE / f"{name}.nml"
    if quick:
        text = folder / f"{name}.nml"
        text.write_text(quick_text((HERE / f"{name}.nml").read_text(), OTHERWISE.get(name, FEW)))
    study = read_study(text)
    if study.keeps_results:
        study.results = folder / f"{name}.cases"
    solved = study.run(store=folder / f"{name}.sqlite", progress=True)
    table = Table(frame_of(solved).to_records(index=False))
    early = table.rows[table["outcome"] != "complete"]
    if early.size:
        raise RuntimeError(f"{name}: {early.size} of {len(table)} cases ended early, the first with: {early['message'][0]}")
    return table


def quick_text(text: str, few: int) -> str:
    """A study with fewer values and coarser meshes, its cases named by their whole paths."""

    def fewer(found: re.Match[str]) -> str:
        numbers = [number.strip() for number in found.group(2).split(",")]
        if "mesh%nodes" in found.group(1):
            numbers = list(dict.fromkeys(str(min(int(number), LARGEST)) for number in numbers))
        elif len(numbers) > few:
            numbers = [numbers[round(i)] for i in np.linspace(0, len(numbers) - 1, few)]
        return found.group(1) + ", ".join(numbers) + " "

    text = text.replace("'cases/", f"'{HERE}/cases/")
    text = re.sub(r"(&vary[^/=]*=[^/]*?values=)([\d.,\s]+(?=/))", fewer, text)
    if "mesh%nodes" not in text:
        text += f"&vary key='mesh%nodes', values={COARSE} /\n"
    return re.sub(r"count=(\d+)", lambda found: f"count={min(int(found.group(1)), few)}", text)
