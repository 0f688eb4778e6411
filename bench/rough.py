"""Rough surfaces at the resolution of their points. MFV_TAMAAS is a Python with tamaas, measured in turn; without it these cells are empty."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from harness import ENVIRONMENT, ROOT, Bench, Case, duration, number, size, slope, stamp, table

from mfv import Case as Solver
from mfv import Scene, surfaces

MFV_RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
TAMAAS = os.environ.get("MFV_TAMAAS", "")
LENGTH, MODULUS, MU, SHARE = 10.0, 1.0, 0.3, 0.6
#: A realisation: exponent, slope, longest wave of the power law, points on the shortest wave, mean pressure over the modulus.
HURST, SLOPE, LONGEST, POINTS, PRESSURE = 0.8, 0.1, 0.5, 8, 0.01
POINTS_COUPLED = (1024, 2048, 10000, 22401, 131072)
POINTS_OF_ROWS, QUICK = (1024, 4096, 16384, 65536, 131072), (1024, 4096)
#: Resolution: waves in the period, and points on the shortest.
WAVES, FINER = 128, (4, 8, 16, 32, 64)
#: Tolerance of Tamaas, and the longest that it may take, seconds.
TOLERANCE, LONGEST_RUN = 1e-8, 200.0
#: The least time of several runs in turn, of MFV and of Tamaas, up to a number of points.
REPEATS, MOST_REPEATED = 7, 4096
SCRIPT = """
import sys, time, numpy as np, tamaas as tm
tm.set_log_level(tm.LogLevel.error)
path, length, pressure, tolerance = sys.argv[1], *map(float, sys.argv[2:])
heights = -np.loadtxt(path)[:-1, 1]
start = time.process_time()
model = tm.Model(tm.model_type.basic_1d, [length], [heights.size])
model.E, model.nu = 1.0, 0.0
solver = tm.PolonskyKeerRey(model, heights, tolerance)
solver.max_iter = 100000
solver.solve(pressure)
print(time.process_time() - start)
"""

#: A process, its processor time and its peak memory: a fork of this one would count its own memory.
SHIM = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss)
"""

TEXT = """## Rough surfaces

One period of a self-affine surface (`mfv.surfaces.self_affine`: exponent {hurst}, roll-off at a twentieth of the period, shortest wave {points} points, rms slope {slope}), rigid,
pressed on a half-plane without friction to a mean pressure of {pressure} E*, a node at every point; or pressed with friction, sheared to Q = {share} mu P, and one cycle of it, without coupling: no key of `&solver`
is given. Processor time of whole processes with their result (up to {most:,} points the least of {repeats} in turn, else once); of the press also that of the solution alone, without reading, stresses and writing. Tamaas {version}
finds the same pressures (PolonskyKeerRey, tolerance {tolerance:.0e}, its time without start and reading); the ratio is that of the solutions:

{time_table}

Time over points: exponent {press_exponent} (press), {cycle_exponent} (with shear and a cycle). Above 4,096 nodes in contact the history has fewer than 8 rows in each segment.
**With full coupling** and an accuracy of 1e-2, press, shear and cycle (errors of the tractions: root mean squares, see [large increments](verification.md#large-increments)):

{coupled}

How many points? A surface with {waves} of its shortest waves in the period, same load, more and more points on a wave: changes from the finest.

{resolution_table}
"""


@dataclass
class Run:
    """What a process took, seconds and bytes, and the solution without reading and result; its numbers."""

    seconds: float
    memory: float
    solution: float
    values: dict[str, float]


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """All rows."""
    rows = []
    for points in QUICK if quick else POINTS_OF_ROWS:
        rows.append(row(bench, points))
        print(rows[-1], flush=True)
    fine = [{"points": finer} | vars(solve(bench, finer * WAVES, WAVES, True)) for finer in FINER]
    coupled = [
        {"points": points} | vars(solve(bench, points, points // POINTS, True, coupled=True))
        for points in POINTS_COUPLED[: 2 if quick else None]
    ]
    return stamp() | {"rows": rows, "fine": fine, "coupled": coupled, "version": version()}


def row(bench: Bench, points: int) -> dict[str, Any]:
    """The least times of a number of points."""
    repeats = REPEATS if points <= MOST_REPEATED else 1
    runs = [[solve(bench, points, points // POINTS, cycled) for cycled in (False, True)] for _ in range(repeats)]
    others = [tamaas(points, points // POINTS) for _ in range(repeats)]
    found: dict[str, Any] = {"points": points, "tamaas": min((other for other in others if other is not None), default=None)}
    for place, name in enumerate(("press", "cycle")):
        times = [run[place] for run in runs]
        found[name] = vars(min(times, key=lambda run: run.seconds)) | {"solution": min(run.solution for run in times)}
    return found


def version() -> str:
    """That of Tamaas."""
    if not TAMAAS:
        return "(not measured)"
    call = [TAMAAS, "-c", "import tamaas; print(tamaas.__version__)"]
    return subprocess.run(call, check=True, capture_output=True, text=True).stdout.strip()


def write_surface(folder: Path, points: int, waves: int) -> Path:
    """A file of the profile, whose shortest wave is a part of the period."""
    profile = surfaces.self_affine(
        points, LENGTH, hurst=HURST, rms_slope=SLOPE, roll_off=LONGEST, cut_off=LENGTH / waves, seed=1, unit="mm"
    )
    path = folder / "surface.txt"
    np.savetxt(path, np.column_stack([profile.x, profile.height]), fmt="%.17g")
    return path


def solve(bench: Bench, points: int, waves: int, cycled: bool, coupled: bool = False) -> Run:
    """Pressed; or pressed, sheared and one cycle."""
    with tempfile.TemporaryDirectory() as folder:
        path = write_surface(Path(folder), points, waves)
        elastic = {"shape": "half_plane", "youngs_modulus": MODULUS * (1.0 - 0.3**2), "poisson_ratio": 0.3}
        press: dict[str, Any] = {"normal_force": PRESSURE * MODULUS * LENGTH}
        steps = [press, *([{"force_ratio": SHARE}, {"force_ratio": -SHARE, "cycles": 1}] if cycled else [])]
        surface = {"shape": "profile", "file": path.name, "rigid": True}
        case = Case(
            [elastic, surface], steps, {"nodes": points, "period": LENGTH}, MU if cycled else None, "full" if coupled else "none"
        )
        if coupled:
            case = case.by(accuracy=1e-2)
        return run_process(bench, case, Path(folder), cycled)


def run_process(bench: Bench, case: Case, folder: Path, cycled: bool) -> Run:
    """The case in a process."""
    from mfv import read

    (folder / "case.nml").write_text(case.text())
    call = [sys.executable, "-c", SHIM, str(MFV_RUN), "case.nml"]
    done = subprocess.run(call, cwd=folder, env=ENVIRONMENT, check=True, capture_output=True, text=True)
    seconds, memory = map(float, done.stdout.split())
    result = read(folder / "case.h5")
    solver = result.attributes["linear_solver"]
    certificate = float(result.summary.largest_residual)
    outcome = 0 if result.outcome == "complete" else 1
    bench.check(case, {"solver": solver, "nodes": result.mesh.x.size, "certificate": certificate, "outcome": outcome}, True)
    names = ["contact_nodes", "patches", "linear_solves", "contact_length", "approach", "dissipation", "events", "leaps"]
    values = {name: float(result.summary[name]) for name in names if name in result.summary}
    if cycled:
        values["cycle_dissipation"] = float(result.cycles.dissipation[-1])
    return Run(seconds, 1024.0 * memory, time_of_solution(folder / "case.nml"), values)


def time_of_solution(path: Path) -> float:
    """Seconds to solve the case, without reading it, its stresses and its result."""
    case = Solver(Scene.from_file(path))
    start = time.process_time()
    case.run()
    return time.process_time() - start


def tamaas(points: int, waves: int) -> float | None:
    """Seconds of Tamaas; None without it, infinite beyond the limit."""
    if not TAMAAS:
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = write_surface(Path(folder), points, waves)
        call = [TAMAAS, "-c", SCRIPT, str(path), str(LENGTH), str(PRESSURE * MODULUS), str(TOLERANCE)]
        try:
            done = subprocess.run(call, check=True, capture_output=True, text=True, env=ENVIRONMENT, timeout=LONGEST_RUN)
        except subprocess.TimeoutExpired:
            return float("inf")
    return float(done.stdout.split()[-1])


def section(data: dict[str, Any], _pictures: Path) -> str:
    """The text."""
    rows = data["rows"]
    points = [row["points"] for row in rows]
    exponents = [slope(points, [row[kind]["seconds"] for row in rows])[0] for kind in ("press", "cycle")]
    finest = data["fine"][-1]["values"]
    return TEXT.format(
        hurst=HURST,
        points=POINTS,
        slope=SLOPE,
        pressure=PRESSURE,
        share=SHARE,
        repeats=REPEATS,
        most=MOST_REPEATED,
        tolerance=TOLERANCE,
        version=data["version"],
        waves=WAVES,
        press_exponent=number(exponents[0]),
        cycle_exponent=number(exponents[1]),
        coupled=coupled_table(data["coupled"]),
        time_table=time_table(rows),
        resolution_table=resolution_table(data["fine"], finest),
    )


def time_table(rows: list[dict[str, Any]]) -> str:
    """A row for each number of points."""
    head = ["points", "patches", "nodes in contact", "press", "of which the solution", "solves", "Tamaas", "Tamaas / MFV"]
    head += ["press, shear, cycle", "solves", "memory"]
    cells = []
    for row in rows:
        press, cycle, other = row["press"], row["cycle"], row["tamaas"]
        beyond = other is not None and not np.isfinite(other)
        seconds = "" if other is None else f"> {LONGEST_RUN:.0f} s" if beyond else duration(other)
        shown = LONGEST_RUN if beyond else other
        ratio = "" if other is None else ("> " if beyond else "") + number(shown / press["solution"])
        cells.append(
            [
                f"{row['points']:,}",
                f"{press['values']['patches']:.0f}",
                f"{press['values']['contact_nodes']:.0f}",
                duration(press["seconds"]),
                duration(press["solution"]),
                f"{press['values']['linear_solves']:.0f}",
                seconds,
                ratio,
                duration(cycle["seconds"]),
                f"{cycle['values']['linear_solves']:.0f}",
                size(cycle["memory"]),
            ]
        )
    return table(head, cells)


def coupled_table(rows: list[dict[str, Any]]) -> str:
    """A row for each number of points with full coupling."""
    head = ["points", "patches", "nodes in contact", "press, shear, cycle", "events", "large increments", "solves", "memory"]
    names = ("patches", "contact_nodes", "events", "leaps", "linear_solves")
    cells = []
    for row in rows:
        patches, contact, events, leaps, solves = (f"{row['values'][name]:.0f}" for name in names)
        cells.append([f"{row['points']:,}", patches, contact, duration(row["seconds"]), events, leaps, solves, size(row["memory"])])
    return table(head, cells)


def resolution_table(rows: list[dict[str, Any]], finest: dict[str, float]) -> str:
    """Contact length, approach and dissipation of a cycle, as changes from the finest."""
    head = ["points on the shortest wave", "nodes in each patch", "patches", "contact length", "approach", "dissipation of a cycle"]
    cells = []
    for row in rows:
        values = row["values"]
        changes = [values[name] / finest[name] - 1.0 for name in ("contact_length", "approach", "cycle_dissipation")]
        inside = f"{values['contact_nodes'] / values['patches']:.0f}"
        cells.append([row["points"], inside, f"{values['patches']:.0f}", *(f"{100.0 * change:+.2g} %" for change in changes)])
    return table(head, cells)
