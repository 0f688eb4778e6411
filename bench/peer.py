"""Jobs that CONTACT (Vollebregt) solves as a one-row line model, measured in turn with MFV. MFV_CONTACT is its program."""

from __future__ import annotations

import itertools
import math
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import contact
import numpy as np
from contact import LENGTH, Job, children
from harness import ENVIRONMENT, ROOT, Bench, Case, duration, number, stamp, table
from matplotlib import pyplot
from numpy.typing import NDArray

from mfv import reference

Array = NDArray[np.float64]
MFV_RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
#: E* = R = a = 1: P = pi E* a^2/(4 R); a rigid disk on a half-plane with E* = E/(1 - nu^2).
FORCE = math.pi / 4.0
SHARE, MU, SLIDING_MU, CYCLE_SHARE = 0.65, 0.7, 0.3, 0.8
SHEAR = SHARE * MU * FORCE
#: Processes are run in turn: the least of this many rounds, of fewer if they take longer than these seconds; one that does, once.
ROUNDS, SPENT = 20, 4.0
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
#: Nodes up to which events are the reference of a job that depends on the path; beyond, MFV is that of CONTACT.
MOST_BY_EVENTS = 2048
#: Without the key, and with it.
ACCURACIES_OF_ROWS = (None, 1e-3, 1e-2)
#: CONTACT's load steps while pressing, and in a quarter of a cycle.
PRESS_STEPS, QUARTER_STEPS = (16, 32), 2


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


def uncoupled_job(*shares: float) -> Callable[[int], dict[str, Job]]:
    """The same for CONTACT: without coupling a load step is exact."""
    job = Job(4.0, tuple((FORCE, share) for share in shares or (0.0,)), MU if shares else None)
    return lambda nodes: {"": job}


def press_job(nodes: int) -> dict[str, Job]:
    """The same for CONTACT, in load steps of equal half-widths."""
    return {f"{count} steps": Job(4.0, pressed(count), MU, True) for count in PRESS_STEPS}


def cycles_job(coupling: str, count: int) -> Callable[[int], dict[str, Job]]:
    """The same for CONTACT; without coupling half a cycle is a load step."""
    coupled = coupling != "none"
    quarter = QUARTER_STEPS if coupled else 0.5
    corners = [0.0, CYCLE_SHARE, *(count * [-CYCLE_SHARE, CYCLE_SHARE])]
    loads = list(pressed(PRESS_STEPS[0])) if coupled else []
    for start, end in itertools.pairwise(corners):
        steps = max(round(abs(end - start) / CYCLE_SHARE * quarter), 1)
        loads += [(FORCE, start + (end - start) * (step + 1) / steps) for step in range(steps)]
    return lambda nodes: {"": Job(2.5, tuple(loads), SLIDING_MU, coupled)}


def rough_job(nodes: int) -> dict[str, Job]:
    """The same for CONTACT."""
    heights = np.loadtxt(rough_profile(nodes))[1:-1, 1]
    return {"": Job(4.0, ((FORCE, SHARE),), MU, heights=heights)}


def pressed(count: int) -> tuple[tuple[float, float], ...]:
    """Normal forces of load steps in which the half-width grows by the same."""
    return tuple((FORCE * ((step + 1) / count) ** 2, 0.0) for step in range(count))


def rough_profile(nodes: int) -> Path:
    """A file with its heights at the nodes, and one beyond either end."""
    draw = np.random.default_rng(1)
    numbers, phases = draw.uniform(*WAVE_NUMBERS, WAVES), draw.uniform(0.0, 2.0 * np.pi, WAVES)
    x = -2.0 + 4.0 / nodes * (np.arange(-1, nodes + 1) + 0.5)
    height = 0.5 * x**2 + AMPLITUDE * 40.0 * np.sum(np.cos(np.outer(x, numbers) + phases) / numbers, axis=1)
    path = Path(tempfile.gettempdir()) / f"mfv_rough_{nodes}.txt"
    np.savetxt(path, np.column_stack([x, height - height.min()]), fmt="%.17g")
    return path


def hertz_error(x: Array, pressure: Array, shear: Array, dissipation: float) -> float:
    """Relative l2 error of the pressure."""
    return relative(pressure, reference.hertz_pressure(x, FORCE, 1.0))


def mindlin_error(x: Array, pressure: Array, shear: Array, dissipation: float) -> float:
    """Relative l2 error of the shear."""
    return relative(shear, reference.mindlin_shear(x, SHEAR, FORCE, 1.0, MU))


def cycle_error(x: Array, pressure: Array, shear: Array, dissipation: float) -> float:
    """Relative error of the dissipation of first loading and a cycle, of which the former is a quarter."""
    return abs(float(dissipation / (1.25 * reference.mindlin_dissipation(SHEAR, FORCE, 1.0, 1.0, MU)) - 1.0))


def relative(found: Any, exact: Any) -> float:
    """Relative l2 difference."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


@dataclass(frozen=True)
class Row:
    """A job, its ways in CONTACT, the error (None: of the shear, against events)."""

    name: str
    case: Callable[[int], Case]
    jobs: Callable[[int], dict[str, Job]]
    error: Callable[[Array, Array, Array, float], float] | None = None
    nodes: tuple[int, ...] = (512, 2048, 8192)


ROWS = (
    Row("Hertz", uncoupled(), uncoupled_job(), hertz_error),
    Row("Cattaneo-Mindlin", uncoupled(SHEAR), uncoupled_job(SHARE), mindlin_error),
    Row("Q, -Q, Q, dissipation", uncoupled(SHEAR, -SHEAR, SHEAR), uncoupled_job(SHARE, -SHARE, SHARE), cycle_error),
    Row("press with friction, full coupling", press, press_job),
    Row("press, two cycles, full coupling", cycles("full", 2), cycles_job("full", 2)),
    Row("rough, 30 patches, uncoupled", rough, rough_job),
)


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """All rows: processor time of both programs, errors; start-up; a cycle of many."""
    if not contact.PROGRAM:
        raise SystemExit("MFV_CONTACT has to be the program of CONTACT, which is measured in turn with MFV")
    rows = [measure_row(bench, row, nodes) for row in ROWS for nodes in row.nodes if not (quick and nodes > MOST_BY_EVENTS)]
    start = in_turn(
        {
            "--version": lambda: process("", "--version"),
            "16 nodes": lambda: process(uncoupled()(16).text()),
            "CONTACT": lambda: contact.solve(uncoupled_job()(16)[""], 16)[0],
        }
    )
    cycle = [_cycle(bench, coupling) for coupling in ("none", "full")]
    return stamp() | {
        "rows": rows,
        "start": start,
        "cycle": cycle,
        "picture": measure_picture(bench, quick),
        "picture_date": stamp()["date"],
    }


def measure_row(bench: Bench, row: Row, nodes: int) -> dict[str, Any]:
    """A job on one mesh."""
    case, jobs = row.case(nodes), row.jobs(nodes)
    cases = {accuracy: case if accuracy is None else case.by(accuracy=accuracy) for accuracy in ACCURACIES_OF_ROWS}
    results = bench.run(list(cases.values()))
    x, exact, error = results[0]["tractions"].x, results[0]["tractions"], row.error
    if error is None:
        if nodes <= MOST_BY_EVENTS:
            exact = bench.run([case.by(stepping="event")])[0]["tractions"]

        def error(x: Array, pressure: Array, shear: Array, dissipation: float) -> float:
            return relative(shear, exact.shear)

    found: dict[str, Any] = {"job": row.name, "nodes": nodes, "contact": [], "mfv": []}
    long: dict[Any, float] = {}
    for name, job in jobs.items():
        seconds, states = contact.solve(job, nodes, every_step=len(job.loads) == 3)
        if seconds > SPENT:
            long[name] = seconds
        work = contact.dissipation(states, job.window / nodes)
        found["contact"].append({"name": name, "error": error(x, states[-1].pressure, states[-1].shear, work)})
    for accuracy, result in zip(cases, results, strict=True):
        end = result["tractions"]
        found["mfv"].append(
            {
                "accuracy": accuracy,
                "solver": result["solver"],
                "solves": result["whole"]["solves"],
                "seconds": result["whole"]["seconds"],
                "error": error(x, end.pressure, end.shear, result["dissipation"]) if row.error or nodes <= MOST_BY_EVENTS else None,
            }
        )
    calls: dict[Any, Callable[[], float]] = {
        name: lambda job=job: contact.solve(job, nodes)[0] for name, job in jobs.items() if name not in long
    }
    calls |= {accuracy: lambda case=case: process(case.text()) for accuracy, case in cases.items()}
    least = long | in_turn(calls)
    for entry in found["contact"]:
        entry["process"] = least[entry["name"]]
    for entry in found["mfv"]:
        entry["process"] = least[entry["accuracy"]]
    print(
        f"  {row.name}, {nodes}: " + ", ".join(f"{name or 'CONTACT'} {duration(value)}" for name, value in least.items()),
        flush=True,
    )
    return found


def in_turn(calls: dict[Any, Callable[[], float]]) -> dict[Any, float]:
    """Least of every call, in rounds."""
    least = dict.fromkeys(calls, math.inf)
    started = time.perf_counter()
    for _ in range(ROUNDS):
        for name, call in calls.items():
            least[name] = min(least[name], call())
        if time.perf_counter() - started > SPENT:
            break
    return least


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


def process(text: str, *options: str) -> float:
    """Processor time of mfv_run, with a result file without history."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "case.nml").write_text(text + "&output history='none', states='none' /\n")
        call = [str(MFV_RUN), *(options or ("case.nml",))]
        started = children()
        subprocess.run(call, check=True, stdout=subprocess.PIPE, env=ENVIRONMENT, cwd=folder, close_fds=False)
        return children() - started


def _cycle(bench: Bench, coupling: str) -> dict[str, Any]:
    """Time of one of many cycles on 512 nodes."""
    seconds = [
        bench.run([cycles(coupling, count)(512).by(accuracy=1e-2, stepping="leap")], 3)[0]["whole"]["seconds"] for count in (1, 101)
    ]
    calls = {count: lambda count=count: contact.solve(cycles_job(coupling, count)(512)[""], 512)[0] for count in (1, 11)}
    least = in_turn(calls)
    return {"coupling": coupling, "seconds": (seconds[1] - seconds[0]) / 100.0, "contact": (least[11] - least[1]) / 10.0}


def draw(points: Sequence[dict[str, Any]], times: dict[int, float], path: Path) -> None:
    """Error over time. CONTACT has at least the error of its mesh."""
    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for name in (*SETTINGS, ALONE):
        own = [point for point in points if point["setting"] == name]
        style = "o-" if name.startswith("accuracy") else "s--"
        axes.loglog([p["seconds"] for p in own], [p["error"] for p in own], style, label=name, markersize=4)
    mesh_error = {point["nodes"]: point["error"] for point in points if point["setting"] in SETTINGS}
    times = {nodes: seconds for nodes, seconds in times.items() if nodes in mesh_error}
    axes.loglog(times.values(), [mesh_error[nodes] for nodes in times], "k^", label="CONTACT, error of its mesh")
    axes.set_xlabel("computing time, s")
    axes.set_ylabel("error of the shear traction (relative, l2)")
    axes.grid(True, which="major", alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=130)
    pyplot.close(figure)


def section(data: dict[str, Any], pictures: Path) -> str:
    """The text, with its picture."""
    times = {row["nodes"]: row["contact"][0]["process"] for row in data["rows"] if row["job"] == "press, two cycles, full coupling"}
    draw(data["picture"], times, pictures / "pareto_accuracy.png")
    names = ["no key" if accuracy is None else f"accuracy={accuracy:g}" for accuracy in ACCURACIES_OF_ROWS]
    head = ["job", "n", "CONTACT", *(cell for name in names for cell in (name, "CONTACT / MFV"))]
    rows = []
    for row in data["rows"]:
        least = min(entry["process"] for entry in row["contact"])
        others = [f"{described(entry)}{', ' * bool(entry['name'])}{entry['name']}" for entry in row["contact"]]
        rows.append([row["job"], row["nodes"], "; ".join(others)])
        for entry in row["mfv"]:
            rows[-1] += [described(entry), number(least / entry["process"])]
    cycle = {row["coupling"]: row for row in data["cycle"]}
    start = data["start"]
    return f"""## Against CONTACT

E* = R = a = 1, n nodes across a window of 4a (cycles: 2.5a). CONTACT (Vollebregt; the public version of July 2025, with transforms of FFTW, planned in an earlier run) solves the same as one
row of elements of length {LENGTH:g}a. Both are compiled with gfortran -O3 and run in turn on one core of a shared machine (load {data["load"]:.1f}): processor time of whole processes, which also write their
result, the least of up to {ROUNDS} runs (one, if it takes longer than {SPENT:g} s). Behind the time is the relative error: of the pressure (l2, Hertz), of the shear (l2; Cattaneo-Mindlin: mu = {MU:g}, Q = {SHARE:g} mu P) or
of the dissipation, against the closed form. In the other jobs it is that of the shear, against events on the same mesh (*exact*: these themselves), for n above {MOST_BY_EVENTS} that of CONTACT against MFV. With coupling
nu = 0; press: mu = {MU:g}; cycles: mu = {SLIDING_MU:g}, Q = {CYCLE_SHARE:g} mu P, for CONTACT {PRESS_STEPS[0]} load steps and {QUARTER_STEPS} for a quarter of a cycle. CONTACT / MFV is the ratio of the times, with the
faster of its ways: MFV is ahead where it is above 1. Without the key it is behind in: {behind(data["rows"])};
apart from start-up (below): {behind(data["rows"], start["16 nodes"], start["CONTACT"])}.

{table(head, rows)}

Start-up: `mfv_run --version` {duration(start["--version"])}, a run of 16 nodes with its result file {duration(start["16 nodes"])}; CONTACT {duration(start["CONTACT"])}. One of many cycles on 512 nodes, by large
increments (`accuracy=1e-2`, computing time): uncoupled {duration(cycle["none"]["seconds"])}, coupled {duration(cycle["full"]["seconds"])}; CONTACT {duration(cycle["none"]["contact"])} and {duration(cycle["full"]["contact"])}.

HDF5 takes 16 of the 22.9 million instructions of the run of 16 nodes (callgrind, 2026-11-28); a C program that only writes as many datasets executes 12.6 million. Compact datasets and other file formats save 6 % of it at most.

![Error of the shear over computing time](pictures/pareto_accuracy.png)

Press and two cycles with full coupling on 64 to 4096 nodes, against {FINEST} nodes (MFV's computing times of {data["picture_date"]}). With an `accuracy`, events are followed up to 256 nodes and large increments taken beyond; their
error is small beside that of the mesh. *Alone*: the number of nodes follows from the accuracy too;
most of its time is for a dissipation of that accuracy. Nominal load steps find the same states as events.
"""


def behind(rows: Sequence[dict[str, Any]], mfv: float = 0.0, contact: float = 0.0) -> str:
    """Rows in which MFV without the key takes longer, apart from the time that both take to start (seconds)."""
    late = [row for row in rows if row["mfv"][0]["process"] - mfv > min(entry["process"] for entry in row["contact"]) - contact]
    return ", ".join(f"{row['job']} ({row['nodes']})" for row in late) or "none"


def described(entry: dict[str, Any]) -> str:
    """Time and error."""
    return duration(entry["process"]) + (
        "" if entry["error"] is None else f", {entry['error']:.0e}" if entry["error"] > 0.0 else ", exact"
    )
