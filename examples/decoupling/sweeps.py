"""The sweeps of the study: how they are run with mfv_sweep, and their tables."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import mfv

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

#: What a quick study leaves of an axis: so many values, and meshes of at most so many nodes; other cases have COARSE.
FEW, OTHERWISE, LARGEST, COARSE = 4, {"small_force": 9, "laws": 1}, 195, 97


class Table:
    """Rows of a sweep's table: columns by name, rows by values."""

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


def program(path: str | None) -> str:
    """The program mfv_sweep: as told, from MFV_SWEEP, of the build of this repository, or of the system."""
    built = HERE.parents[1] / "build" / "release" / "bin" / "mfv_sweep"
    for candidate in (path, os.environ.get("MFV_SWEEP"), str(built), shutil.which("mfv_sweep")):
        if candidate and Path(candidate).is_file():
            return candidate
    raise FileNotFoundError("mfv_sweep is not there: build it (cmake --build --preset release) or tell --program")


def run(name: str, folder: Path, executable: str, quick: bool) -> Table:
    """The table of a sweep, which is solved where `folder` does not have it yet. Raises RuntimeError where that fails."""
    sweep = HERE / f"{name}.nml"
    if quick:
        sweep = folder / f"{name}.nml"
        sweep.write_text(quick_text((HERE / f"{name}.nml").read_text(), OTHERWISE.get(name, FEW)))
    done = subprocess.run([executable, str(sweep)], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"mfv_sweep {sweep} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    table = Table(np.asarray(mfv.read_table(folder / f"{name}.h5")))
    early = table.rows[table["outcome"] != "complete"]
    if early.size:
        raise RuntimeError(f"{name}: {early.size} of {len(table)} cases ended early, the first with: {early['message'][0]}")
    return table


def quick_text(text: str, few: int) -> str:
    """A sweep with fewer values and coarser meshes, its cases named by their whole paths."""

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
