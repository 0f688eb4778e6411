"""Jobs for which CONTACT (Vollebregt) has been measured, as a one-row line model: its times are quoted, MFV is measured."""

from __future__ import annotations

import math
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from harness import ENVIRONMENT, ROOT, Bench, Case, duration, stamp, table
from matplotlib import pyplot
from numpy.typing import NDArray

from mfv import reference

MFV_RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
#: E* = R = a = 1: P = pi E* a^2/(4 R); a rigid disk on a half-plane with E* = E/(1 - nu^2).
FORCE = math.pi / 4.0
SHARE, MU, SLIDING_MU, CYCLE_SHARE = 0.65, 0.7, 0.3, 0.8
SHEAR = SHARE * MU * FORCE
#: Runs take the least of this many, fewer if one takes longer than a second.
REPEATS = 20
#: Rough surface: number of cosines, wave numbers, amplitude of the wave number 40 (others in proportion to the wave length).
WAVES, WAVE_NUMBERS, AMPLITUDE = 40, (20.0, 160.0), 6.8e-3
#: Settings of the picture, with the keys of &solver and the numbers of nodes; the finest mesh, which is the reference.
SETTINGS: dict[str, tuple[dict[str, Any], tuple[int, ...]]] = {
    "events, reduced": ({"stepping": "event", "linear_solver": "reduced"}, (64, 128, 256, 512, 1024)),
    "events, fft": ({"stepping": "event", "linear_solver": "fft"}, (64, 128, 256, 512, 1024)),
    "nominal load steps": ({"stepping": "nominal"}, (64, 128, 256, 512)),
    "accuracy 1e-2": ({"accuracy": 1e-2}, (64, 128, 256, 512, 1024, 2048, 4096)),
    "accuracy 2e-3": ({"accuracy": 2e-3}, (64, 128, 256, 512, 1024, 2048, 4096)),
}
FINEST = 8192
#: And this key alone, from which the number of nodes follows.
ALONE, ACCURACIES = "accuracy alone, 1e-2 to 1e-4", (1e-2, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4)
#: CONTACT's times, seconds, for the case of the picture.
CONTACT_CYCLES = {512: 1.3, 1024: 3.1, 2048: 6.3, 8192: 34.0}
#: Nodes up to which events are the reference of a job that depends on the path; fewest for which an accuracy then has an effect.
MOST_BY_EVENTS, FEWEST_BY_INCREMENTS = 2048, 384


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


def rough(nodes: int) -> Case:
    """A parabola with random cosines, pressed without friction and sheared; about 30 patches."""
    elastic = {"shape": "half_plane", "youngs_modulus": 1.0 - 0.3**2, "poisson_ratio": 0.3}
    surface = {"shape": "profile", "file": str(rough_profile(nodes)), "rigid": True}
    steps = [{"normal_force": FORCE, "friction": False}, {"tangential_force": SHEAR}]
    return Case([elastic, surface], steps, {"nodes": nodes, "half_width": 2.0}, MU, "none")


def rough_profile(nodes: int) -> Path:
    """A file with its heights at the nodes, and one beyond either end."""
    draw = np.random.default_rng(1)
    numbers, phases = draw.uniform(*WAVE_NUMBERS, WAVES), draw.uniform(0.0, 2.0 * np.pi, WAVES)
    x = -2.0 + 4.0 / nodes * (np.arange(-1, nodes + 1) + 0.5)
    height = 0.5 * x**2 + AMPLITUDE * 40.0 * np.sum(np.cos(np.outer(x, numbers) + phases) / numbers, axis=1)
    path = Path(tempfile.gettempdir()) / f"mfv_rough_{nodes}.txt"
    np.savetxt(path, np.column_stack([x, height - height.min()]), fmt="%.17g")
    return path


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
    Row("rough, 30 patches", rough, {2048: "0.09 s (27 patches)", 8192: "0.58 s"}, (0.0, 1e-3)),
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
    cycle = [_cycle(bench, coupling) for coupling in ("none", "full")]
    return stamp() | {"rows": rows, "start": start, "cycle": cycle, "picture": measure_picture(bench, quick)}


def measure_picture(bench: Bench, quick: bool) -> list[dict[str, Any]]:
    """Time and error of the shear for all settings and meshes: press and two cycles with full coupling."""
    case = cycles("full", 2)
    exact = bench.run([case(FINEST // 4 if quick else FINEST).by(accuracy=1e-3)])[0]["tractions"]
    few = slice(3 if quick else None)
    cases = [(name, case(nodes).by(**keys)) for name, (keys, meshes) in SETTINGS.items() for nodes in meshes[few]]
    cases += [(ALONE, replace(case(FINEST), mesh={"gap": "parabolic"}).by(accuracy=accuracy)) for accuracy in ACCURACIES[few]]
    points = []
    for name, each in cases:
        result = bench.run([each], 2)[0]
        error = error_on_mesh(result["tractions"], exact)
        nodes = len(result["tractions"].x)
        points.append({"setting": name, "nodes": nodes, "seconds": result["whole"]["seconds"], "error": error})
    return points


def error_on_mesh(found: Any, exact: Any) -> float:
    """Relative l2 error of the shear against that on a finer mesh."""
    shear: NDArray[np.float64] = np.interp(found.x, exact.x, exact.shear)
    return relative(found.shear, shear)


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


def draw(points: Sequence[dict[str, Any]], path: Path) -> None:
    """Error over time. CONTACT has at least the error of its mesh."""
    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for name in (*SETTINGS, ALONE):
        own = [point for point in points if point["setting"] == name]
        style = "o-" if name.startswith("accuracy") else "s--"
        axes.loglog([p["seconds"] for p in own], [p["error"] for p in own], style, label=name, markersize=4)
    mesh_error = {point["nodes"]: point["error"] for point in points if point["setting"] in SETTINGS}
    contact = {nodes: seconds for nodes, seconds in CONTACT_CYCLES.items() if nodes in mesh_error}
    axes.loglog(contact.values(), [mesh_error[nodes] for nodes in contact], "k^", label="CONTACT, error of its mesh")
    axes.set_xlabel("computing time, s")
    axes.set_ylabel("error of the shear traction (relative, l2)")
    axes.grid(True, which="major", alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=130)
    pyplot.close(figure)


def section(data: dict[str, Any], pictures: Path) -> str:
    """The text, with its picture."""
    draw(data["picture"], pictures / "pareto_accuracy.png")
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

![Error of the shear over computing time](pictures/pareto_accuracy.png)

Press and two cycles with full coupling on 64 to 4096 nodes, against {FINEST} nodes. With an `accuracy`, events are followed up to 256 nodes and large increments taken beyond; their
error is small beside that of the mesh. *Alone*: the number of nodes follows from the accuracy too;
most of its time is for a dissipation of that accuracy. Nominal load steps find the same states as events.
"""
