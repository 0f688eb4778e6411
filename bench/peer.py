"""Jobs for which CONTACT (Vollebregt) has been measured, as a one-row line model: its times are quoted, MFV is measured."""

from __future__ import annotations

import math
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from harness import ENVIRONMENT, ROOT, Bench, Case, duration, stamp, table

from mfv import reference

MFV_RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
#: E* = R = a = 1: P = pi E* a^2/(4 R); a rigid disk on a half-plane with E* = E/(1 - nu^2).
FORCE = math.pi / 4.0
SHARE, MU, SLIDING_MU, CYCLE_SHARE = 0.65, 0.7, 0.3, 0.8
SHEAR = SHARE * MU * FORCE
#: Runs take the least of this many, fewer if one takes longer than a second.
REPEATS = 20
#: Nodes up to which events are the reference of a job that depends on the path; fewest for which an accuracy then has an effect.
MOST_BY_EVENTS, FEWEST_BY_INCREMENTS = 2048, 640


def case_of(steps: Sequence[dict[str, Any]], nodes: int, window: float, mu: float | None, nu: float, coupling: str) -> Case:
    """A rigid disk on a half-plane, with `nodes` nodes across a window (in units of a)."""
    elastic = {"shape": "half_plane", "youngs_modulus": 1.0 - nu**2, "poisson_ratio": nu}
    mesh = {"nodes": nodes, "half_width": 0.5 * window, "gap": "parabolic"}
    return Case([elastic, {"shape": "disk", "radius": 1.0, "rigid": True}], list(steps), mesh, mu, coupling)


def uncoupled(*forces: float) -> Callable[[int], Case]:
    """Pressed without friction, then sheared to these forces."""
    press = {"normal_force": FORCE} | ({"friction": False} if forces else {})
    steps = [press, *({"tangential_force": force} for force in forces)]
    return lambda nodes: case_of(steps, nodes, 4.0, MU if forces else None, 0.3, "none")


def press(nodes: int) -> Case:
    """Pressed with friction and full coupling."""
    return case_of([{"normal_force": FORCE}], nodes, 4.0, MU, 0.0, "full")


def cycles(coupling: str, count: int) -> Callable[[int], Case]:
    """Pressed with friction, sheared back and forth `count` times."""
    shear = CYCLE_SHARE * SLIDING_MU * FORCE
    steps = [{"normal_force": FORCE}, {"tangential_force": shear}, {"tangential_force": -shear, "cycles": count}]
    return lambda nodes: case_of(steps, nodes, 2.5, SLIDING_MU, 0.0, coupling)


def hertz_error(result: dict[str, Any]) -> float:
    """Relative l2 error of the pressure."""
    tractions = result["tractions"]
    return relative(tractions.pressure, reference.hertz_pressure(tractions.x, FORCE, 1.0))


def mindlin_error(result: dict[str, Any]) -> float:
    """Relative l2 error of the shear."""
    tractions = result["tractions"]
    return relative(tractions.shear, reference.mindlin_shear(tractions.x, SHEAR, FORCE, 1.0, MU))


def cycle_error(result: dict[str, Any]) -> float:
    """Relative error of the dissipation of first loading and a cycle, of which the former is a quarter."""
    return abs(float(result["dissipation"] / (1.25 * reference.mindlin_dissipation(SHEAR, FORCE, 1.0, 1.0, MU)) - 1.0))


def relative(found: Any, exact: Any) -> float:
    """Relative l2 difference."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


@dataclass(frozen=True)
class Row:
    """A job: what is quoted of CONTACT for each number of nodes, the accuracies to try, the error (None: against events)."""

    name: str
    case: Callable[[int], Case]
    contact: dict[int, str]
    accuracies: tuple[float, ...]
    error: Callable[[dict[str, Any]], float] | None = None


ROWS = (
    Row("Hertz", uncoupled(), {512: "4.7 ms", 2048: "14 ms", 8192: "144 ms"}, (0.0,), hertz_error),
    Row(
        "Cattaneo-Mindlin",
        uncoupled(SHEAR),
        {512: "11 ms", 2048: "43 ms", 8192: "345 ms", 32768: "1.6 s", 131072: "23.6 s"},
        (1e-3,),
        mindlin_error,
    ),
    Row(
        "Q, -Q, Q, dissipation",
        uncoupled(SHEAR, -SHEAR, SHEAR),
        {512: "40 ms, 1.3e-4", 2048: "186 ms, 9e-6", 8192: "1.7 s, 1e-7"},
        (1e-3,),
        cycle_error,
    ),
    Row(
        "press with friction, full coupling",
        press,
        {
            512: "0.31 s (32 steps, 4e-3), 1.4 s (128, 5e-4)",
            2048: "1.9 s (32, 5e-3), 6.6 s (128, 7e-4)",
            8192: "6.7 s (16, 1.2e-2), 21 s (32, 5e-3)",
        },
        (0.0, 1e-2, 2e-3),
    ),
    Row(
        "press, two cycles, full coupling",
        cycles("full", 2),
        {512: "1.3 s (1.7e-3 after pressing, 7e-5 in cycles)", 1024: "3.1 s", 2048: "6.3 s", 8192: "34 s"},
        (0.0, 1e-1, 1e-2, 2e-3),
    ),
)


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """All rows: computing time, wall time of mfv_run, error; start-up; a cycle of many."""
    rows = []
    for row in ROWS:
        for nodes, contact in row.contact.items():
            if quick and nodes > MOST_BY_EVENTS:
                continue
            exact = None
            for accuracy in row.accuracies:
                if row.error is None and nodes > MOST_BY_EVENTS and accuracy == 0.0:
                    continue
                if row.error is None and nodes < FEWEST_BY_INCREMENTS and accuracy > 0.0:
                    continue
                case = row.case(nodes).by(accuracy=accuracy)
                result = bench.run([case], 1 if row.error is None and nodes >= MOST_BY_EVENTS else 3)[0]
                if row.error is not None:
                    error = row.error(result)
                elif accuracy == 0.0:
                    exact, error = result["tractions"].shear, 0.0
                else:
                    error = math.nan if exact is None else relative(result["tractions"].shear, exact)
                rows.append(
                    {
                        "job": row.name,
                        "nodes": nodes,
                        "contact": contact,
                        "accuracy": accuracy,
                        "solver": result["solver"],
                        "solves": result["whole"]["solves"],
                        "seconds": result["whole"]["seconds"],
                        "wall": wall_time(case.text()),
                        "error": error,
                    }
                )
    trivial = uncoupled()(16).text()
    start = {"--version": wall_time("", "--version"), "16 nodes": wall_time(trivial, steps=False)}
    return stamp() | {"rows": rows, "start": start, "cycle": [_cycle(bench, coupling) for coupling in ("none", "full")]}


def wall_time(text: str, *options: str, steps: bool = True) -> float:
    """Least wall time of mfv_run, with a result file without history."""
    least, spent = math.inf, 0.0
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "case.nml").write_text(text + ("&output history='none', states='none' /\n" if steps else ""))
        call = [str(MFV_RUN), *(options or ("case.nml",))]
        for _ in range(REPEATS):
            started = time.perf_counter()
            subprocess.run(call, check=True, stdout=subprocess.PIPE, env=ENVIRONMENT, cwd=folder, close_fds=False)
            least = min(least, time.perf_counter() - started)
            spent += time.perf_counter() - started
            if spent > 3.0:
                break
    return least


def _cycle(bench: Bench, coupling: str) -> dict[str, Any]:
    """Computing time of one of 100 cycles on 512 nodes."""
    seconds = [
        bench.run([cycles(coupling, count)(512).by(accuracy=1e-2, stepping="leap")], 3)[0]["whole"]["seconds"] for count in (1, 101)
    ]
    return {"coupling": coupling, "seconds": (seconds[1] - seconds[0]) / 100.0}


def section(data: dict[str, Any]) -> str:
    """The text."""
    head = ["job", "n", "CONTACT: time, error", "accuracy", "MFV computes", "mfv_run", "solves", "error"]
    rows = [
        [
            row["job"],
            row["nodes"],
            row["contact"],
            f"{row['accuracy']:g}",
            f"{duration(row['seconds'])} ({row['solver']})",
            duration(row["wall"]),
            row["solves"],
            "-" if not row["error"] > 0.0 else f"{row['error']:.1e}",
        ]
        for row in data["rows"]
    ]
    cycle = {row["coupling"]: duration(row["seconds"]) for row in data["cycle"]}
    return f"""## Against CONTACT

E* = R = a = 1, n nodes across a window of 4a (cycles: 2.5a). CONTACT's times, of whole processes, were measured beside an older MFV (cf1d146) on another machine, both compiled
with gfortran -O3 on one core; on the same mesh its errors in the uncoupled jobs are those of MFV. *mfv_run* is a whole process that also writes its result. The error is the
relative l2 error of the pressure (Hertz), of the shear (Cattaneo-Mindlin: mu = {MU:g}, Q = {SHARE:g} mu P) or that of the dissipation, against the closed form; with coupling
(nu = 0) that of the shear, against events (`accuracy=0`) on the same mesh up to n = {MOST_BY_EVENTS}. Press: mu = {MU:g}; cycles: mu = {SLIDING_MU:g}, Q = {CYCLE_SHARE:g} mu P.

{table(head, rows)}

Start-up: `mfv_run --version` {duration(data["start"]["--version"])}, a run of 16 nodes with its result file {duration(data["start"]["16 nodes"])}; CONTACT 2 ms. One of 100 cycles on
512 nodes by large increments (`accuracy=1e-2`): uncoupled {cycle["none"]}, coupled {cycle["full"]}; CONTACT 35 and 262 ms.
"""
