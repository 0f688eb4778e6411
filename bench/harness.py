"""Shared by all sections: cases, runs of the program `bench`, tables, fits."""

from __future__ import annotations

import datetime
import json
import os
import subprocess
import tempfile
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
SOLVERS = ("dgesv", "reduced", "fft")
Group = dict[str, Any]
#: Limits of certificates: with fft and its default tolerance, and with a factorisation; of large increments, over their accuracy.
CERTIFICATE, CERTIFICATE_DIRECT, CERTIFICATE_OF_INCREMENTS = 1e-8, 1e-10, 1e-2
#: The accuracy without a key, and the fewest nodes for which it is not zero.
DEFAULT_ACCURACY, FEWEST_BY_INCREMENTS = 1e-3, 384


@dataclass
class Case:
    """A case, written as a namelist."""

    bodies: list[Group]
    steps: list[Group]
    mesh: Group
    mu: float | None = None
    coupling: str = "full"
    solver: Group = field(default_factory=dict)

    def text(self) -> str:
        """The namelist."""
        groups: list[tuple[str, Group]] = [("scene", {"coupling": self.coupling})]
        groups += [("body", body) for body in self.bodies]
        groups += [("mesh", self.mesh)]
        groups += [("friction", {"law": "coulomb", "mu": self.mu})] if self.mu is not None else []
        groups += [("step", step) for step in self.steps]
        groups += [("solver", self.solver)] if self.solver else []
        return "".join(f"&{name} {', '.join(f'{k}={_value(v)}' for k, v in keys.items())} /\n" for name, keys in groups)

    def by(self, **solver: Any) -> Case:
        """The same with other keys in &solver."""
        return Case(self.bodies, self.steps, self.mesh, self.mu, self.coupling, self.solver | solver)

    def on(self, nodes: int) -> Case:
        """The same with another number of nodes."""
        return Case(self.bodies, self.steps, self.mesh | {"nodes": nodes}, self.mu, self.coupling, self.solver)

    def coupled(self, coupling: str) -> Case:
        """The same with another coupling."""
        return Case(self.bodies, self.steps, self.mesh, self.mu, coupling, self.solver)


def _value(value: Any) -> str:
    """A value as written in a namelist."""
    if isinstance(value, bool):
        return f".{str(value).lower()}."
    return f"'{value}'" if isinstance(value, str) else repr(value)


@dataclass
class Tractions:
    """Position, pressure and shear of every node."""

    x: NDArray[np.float64]
    pressure: NDArray[np.float64]
    shear: NDArray[np.float64]


class Bench:
    """The program, and the violations of its runs."""

    def __init__(self, program: Path, limit: float) -> None:
        self.program = program
        self.limit = limit
        self.runs = 0
        self.largest_certificate = 0.0
        self.broken: list[str] = []

    def run(self, cases: Sequence[Case], repeats: int = 1, strict: bool = True) -> list[dict[str, Any]]:
        """Solve cases in turn in one process, `repeats` times; with the tractions at the end as `tractions`.

        `strict`: an early end, or a certificate above the limit of the linear solver, is a violation.
        """
        with tempfile.TemporaryDirectory() as folder:
            paths = [Path(folder) / f"case{i}.nml" for i in range(len(cases))]
            for path, case in zip(paths, cases, strict=True):
                path.write_text(case.text())
            output = self._call("tractions", repeats, paths)
            results = [json.loads(line) for line in output.splitlines()]
            for path, result in zip(paths, results, strict=True):
                values = np.fromfile(f"{path}.tractions").reshape(3, -1)
                result["tractions"] = Tractions(*values)
        for case, result in zip(cases, results, strict=True):
            self.check(case, result, strict)
        return results

    def _call(self, command: str, repeats: int, paths: Iterable[Path]) -> str:
        call = [str(argument) for argument in (self.program, command, repeats, *paths)]
        done = subprocess.run(call, check=True, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT, timeout=self.limit)
        return str(done.stdout)

    def process(self, case: Case, repeats: int) -> dict[str, Any]:
        """Solve a case in a separate process: minimum wall time of the process; `memory`: its peak, bytes."""
        least = float("inf")
        best: dict[str, Any] = {}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case.nml"
            path.write_text(case.text())
            call = [str(self.program), "run", "1", str(path)]
            for _ in range(repeats):
                started = time.perf_counter()
                child = subprocess.run(
                    call, check=True, stdout=subprocess.PIPE, env=ENVIRONMENT, close_fds=False, timeout=self.limit
                )
                wall = time.perf_counter() - started
                if wall < least:
                    least, best = wall, json.loads(child.stdout)
        self.check(case, best, True)
        return best | {"wall": least}

    def check(self, case: Case, result: dict[str, Any], strict: bool) -> None:
        """Check that the outcome is complete and the certificate below the limit of the linear solver."""
        self.runs += 1
        if not strict:
            return
        tolerance = CERTIFICATE if result["solver"] == "fft" else CERTIFICATE_DIRECT
        usual = DEFAULT_ACCURACY if result["nodes"] >= FEWEST_BY_INCREMENTS and case.solver.get("stepping") != "event" else 0.0
        tolerance = max(tolerance, CERTIFICATE_OF_INCREMENTS * case.solver.get("accuracy", usual))
        self.largest_certificate = max(self.largest_certificate, result["certificate"])
        if result["outcome"] != 0 or not result["certificate"] <= tolerance:
            self.broken.append(f"outcome {result['outcome']}, certificate {result['certificate']:.1e}: {case.text()}")


def plain(result: Mapping[str, Any]) -> dict[str, Any]:
    """A result without its tractions, to be saved."""
    return {key: value for key, value in result.items() if key not in ("tractions", "case")}


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A Markdown table: the first column is text, the others numbers."""
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def slope(x: Sequence[float], y: Sequence[float]) -> tuple[float, float]:
    """Exponent and factor of the power law through the points."""
    exponent, logarithm = np.polyfit(np.log(x), np.log(y), 1)
    return float(exponent), float(np.exp(logarithm))


def duration(seconds: float) -> str:
    """A time with its unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{number(seconds / size)} {unit}"
    return f"{number(seconds / 1e-6)} µs"


def number(value: float, digits: int = 2) -> str:
    """A number with this many digits, with an exponent only if it is large or small."""
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 1e6:
        places = max(digits - 1 - int(np.floor(np.log10(abs(value)))), 0)
        return f"{value:.{places}f}"
    return f"{value:.{digits - 1}e}"


def size(value: float) -> str:
    """A number of bytes with its unit."""
    return f"{value / 1e6:.0f} MB"


def stamp() -> dict[str, Any]:
    """Date and load of the machine."""
    return {"date": datetime.date.today().isoformat(), "load": os.getloadavg()[0]}
