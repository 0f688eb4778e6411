"""The jobs of the table in which CONTACT (Vollebregt), run as a one-row line model, has been measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from harness import Bench, Case, Tractions, duration, number, plain, stamp, table

from mfv import reference

WINDOW, HALF_WIDTH, RADIUS, MODULUS, MU, SHARE, POISSON = 4.0, 1.0, 1.0, 1.0, 0.7, 0.65, 0.3
#: Hertz: P = pi E* a^2/(4 R), E* = E/(1 - nu^2).
FORCE = float(np.pi) * MODULUS * HALF_WIDTH**2 / (4.0 * RADIUS)
SHEAR = SHARE * MU * FORCE
NODES = (512, 2048, 8192)
#: The mesh that just spans the contact, relative to the window.
NARROW = 1.02 * 2.0 * HALF_WIDTH / WINDOW
REPEATS = 60
#: Stick ratio of the frictional press (nu = 0, mu = 0.7), of the issue.
PRESS_STICK_RATIO = 0.745


@dataclass(frozen=True)
class Published:
    """Time of CONTACT in seconds, including process and start-up, and its error."""

    seconds: float
    error: float


PUBLISHED = {
    "hertz": (Published(14e-3, 8.6e-4), Published(41e-3, 2.1e-4), Published(169e-3, 5.4e-5)),
    "cattaneo": (Published(36e-3, 2.0e-3), Published(120e-3, 4.7e-4), Published(387e-3, 1.0e-4)),
    "cycle": (Published(80e-3, 1.5e-4), Published(0.37, 1.5e-4), Published(2.1, 1.5e-4)),
}
NAMES = {
    "hertz": "Hertz, l2 error of p",
    "cattaneo": "Cattaneo-Mindlin, l2 error of q",
    "cycle": "0, Q, -Q, Q, error of the dissipation",
}


def case_of(job: str, nodes: int, narrow: bool = False) -> Case:
    """A job on `nodes` nodes across the window, or `narrow`: on intervals of the same width that span the contact alone."""
    elastic = {"shape": "half_plane", "youngs_modulus": MODULUS * (1.0 - POISSON**2), "poisson_ratio": POISSON}
    half_width = 0.5 * WINDOW
    if narrow:
        few = int(np.ceil(0.5 * NARROW * nodes)) * 2
        half_width, nodes = half_width * few / nodes, few
    steps: list[dict[str, Any]] = [{"normal_force": FORCE}]
    if job != "hertz":
        steps = [{"normal_force": FORCE, "friction": False}, {"tangential_force": SHEAR}]
    if job == "cycle":
        steps.append({"tangential_force": -SHEAR, "cycles": 1})
    return Case(
        [elastic, {"shape": "disk", "radius": RADIUS, "rigid": True}],
        steps,
        {"nodes": nodes, "half_width": half_width, "gap": "parabolic"},
        None if job == "hertz" else MU,
        "none",
        {"stepping": "leap", "accuracy": 1e-3} if job != "hertz" else {},
    )


def press_case(nodes: int) -> Case:
    """The frictional press, full coupling."""
    elastic = {"shape": "half_plane", "youngs_modulus": MODULUS, "poisson_ratio": 0.0}
    return Case(
        [elastic, {"shape": "disk", "radius": RADIUS, "rigid": True}],
        [{"normal_force": FORCE}],
        {"nodes": nodes, "half_width": 0.5 * WINDOW, "gap": "parabolic"},
        MU,
    )


def error_of(job: str, result: dict[str, Any]) -> float:
    """Against the closed form: l2 over the nodes, or relative."""
    tractions: Tractions = result["tractions"]
    if job == "cycle":
        cycle = reference.mindlin_dissipation(SHEAR, FORCE, HALF_WIDTH, RADIUS, MU)
        # First loading dissipates a quarter of a cycle.
        return abs(float(result["dissipation"] / (1.25 * cycle)) - 1.0)
    if job == "hertz":
        found, exact = tractions.pressure, reference.hertz_pressure(tractions.x, FORCE, HALF_WIDTH)
    else:
        found, exact = tractions.shear, reference.mindlin_shear(tractions.x, SHEAR, FORCE, HALF_WIDTH, MU)
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """All cells: compute time in the process, wall time of the process, error; for every solver that makes sense."""
    jobs: dict[str, list[dict[str, Any]]] = {}
    for job in NAMES:
        jobs[job] = []
        for nodes, published in zip(NODES, PUBLISHED[job], strict=True):
            cell = _cell(bench, job, case_of(job, nodes), 3 if quick else REPEATS)
            if not reaches(cell["error"], published.error):
                cell["enough"] = _smallest(bench, job, nodes, published.error)
            jobs[job].append(cell)
    return stamp() | {"jobs": jobs, "solvers": _solvers(bench), "press": _press(bench), "start": _start(bench)}


def _cell(bench: Bench, job: str, case: Case, repeats: int) -> dict[str, Any]:
    """One job on one mesh."""
    result = bench.run([case])[0]
    error = error_of(job, result)
    process = bench.process(case, repeats)
    return plain(process) | {"error": error, "seconds": process["whole"]["seconds"], "given_nodes": case.mesh["nodes"]}


def _smallest(bench: Bench, job: str, nodes: int, wanted: float) -> dict[str, Any]:
    """The smallest of some meshes that reaches an error, spanning the contact alone."""
    fine = nodes
    for _ in range(20):
        fine = int(fine * 1.05) // 2 * 2
        case = case_of(job, fine, True)
        if reaches(error_of(job, bench.run([case])[0]), wanted):
            return _cell(bench, job, case, REPEATS) | {"window_nodes": fine}
    return {}


def _solvers(bench: Bench) -> list[dict[str, Any]]:
    """Times of the linear solvers for these jobs at n = 512, in one process."""
    rows = []
    for job in NAMES:
        case = case_of(job, NODES[0])
        for result in bench.run([case.by(linear_solver=solver) for solver in ("reduced", "fft")], 3):
            rows.append({"job": job, "solver": result["solver"], "seconds": result["whole"]["seconds"]})
    return rows


def _press(bench: Bench) -> list[dict[str, Any]]:
    """The frictional press by events."""
    rows = []
    for solver in ("reduced", "fft"):
        result = bench.process(press_case(NODES[0]).by(linear_solver=solver), 3)
        rows.append(plain(result) | {"ratio": result["stuck"] / result["contact"]})
    return rows


def _start(bench: Bench) -> float:
    """Wall time of a process with a trivial case."""
    return float(bench.process(case_of("hertz", 16), REPEATS)["wall"])


def reaches(error: float, published: float) -> bool:
    """Whether an error is no larger than a published one, to its two digits."""
    return float(f"{error:.1e}") <= published


def ahead(job: str, place: int, cell: dict[str, Any]) -> tuple[float, dict[str, Any]]:
    """Speed-up over the published time at the same or a smaller error, and its cell."""
    own = cell.get("enough") or cell
    return PUBLISHED[job][place].seconds / own["wall"], own


def section(data: dict[str, Any]) -> str:
    """The text."""
    rows = []
    for job, cells in data["jobs"].items():
        for place, cell in enumerate(cells):
            published = PUBLISHED[job][place]
            ratio, own = ahead(job, place, cell)
            fine = "" if own is cell else f"{own['window_nodes']} ({own['contact']}): {duration(own['wall'])}, {own['error']:.1e}"
            rows.append(
                [
                    NAMES[job],
                    NODES[place],
                    f"{duration(published.seconds)}, {published.error:.1e}",
                    f"{duration(cell['seconds'])}",
                    f"{duration(cell['wall'])}, {cell['error']:.1e}",
                    fine,
                    number(ratio),
                ]
            )
    press = data["press"][0]
    head = ["job", "n", "CONTACT", "MFV computes", "MFV, process", "finer: n (in contact)", "ratio"]
    solvers = sorted({row["solver"] for row in data["solvers"]})
    best = {(row["job"], row["solver"]): row["seconds"] for row in data["solvers"]}
    return f"""## Against CONTACT

Vollebregt's CONTACT as a one-row line model; its times, including its start-up of about 10 ms, were measured elsewhere on a similar machine, so that ratios are only indicative.
E* = R = a = 1, n nodes across a window of 4a, of which n/2 are in contact; mu = {MU}, Q = {SHARE} mu P. MFV solves frictionless jobs directly and the others with
`stepping='leap'`, `accuracy=1e-3`, solver `auto`. Errors are against Hertz and Cattaneo-Mindlin at the nodes, that of the dissipation over first loading and a whole cycle. *Process* is
the wall time of a process that reads the case and solves it (the least of {REPEATS}), of which start-up takes {duration(data["start"])}. If the error on the same mesh
is larger, *finer* is the mesh, over the contact only, that reaches CONTACT's error. *Ratio* is CONTACT's time over that of the MFV process at the same or a smaller error.

{table(head, rows)}

Pressing a rigid cylinder with friction, full coupling, mu = {MU}, nu = 0, n = {NODES[0]}, by events: MFV
{duration(press["wall"])} with reduced ({press["whole"]["events"]} events, {press["whole"]["solves"]} solves) and {duration(data["press"][1]["wall"])} with fft. The stick ratio is {press["ratio"]:.3f}; the
limit is {PRESS_STICK_RATIO}.

Computing times of the solvers at n = {NODES[0]} in one process.

{table(["job", *solvers], [[NAMES[job], *(duration(best[job, solver]) for solver in solvers)] for job in NAMES])}
"""
