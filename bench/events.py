"""Cost of an event against the number of nodes in contact, for every linear solver."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from harness import ROOT, SOLVERS, Bench, Case, duration, number, plain, size, slope, stamp, table
from matplotlib import pyplot

CONTACTS = (40, 80, 160, 331, 1000, 3000, 10000)
MU, PRESS, SHEAR = 0.5, 1.0e-3, 3.0e-4
#: Largest number of contact nodes for each solver, and for the whole load history.
MOST = {"dgesv": 1000, "reduced": 3000, "fft": 10000}
WHOLE = {"dgesv": 331, "reduced": 1000, "fft": 1000}
#: Approximate number of shear events.
EVENTS = {"dgesv": 10, "reduced": 60, "fft": 60}
#: Number of events of a shorter run, which is subtracted.
FEW = 2
BODIES = [
    {"shape": "half_plane", "shear_modulus": 1.0, "poisson_ratio": 0.3},
    {"shape": "disk", "radius": 0.25, "rigid": True},
]
#: Families of scenes, which differ in the cost of a linear solve.
FAMILIES = {
    "full coupling": {"coupling": "full"},
    "Goodman": {"coupling": "goodman"},
    "decoupled": {"coupling": "none"},
}

#: Large increments are the default from 384 nodes on.
BY_EVENTS = {"stepping": "event"}


def cycles(contact: int, number_of: int = 1, coupling: str = "full") -> Case:
    """Press with friction, shear cycles, by events; `contact` nodes in contact, about."""
    steps = [{"normal_force": PRESS}, {"tangential_force": SHEAR, "cycles": number_of}]
    return Case(BODIES, steps, {"nodes": round(1.2 * contact)}, MU, coupling, BY_EVENTS)


def little(contact: int, events: int, coupling: str = "full") -> Case:
    """Press without friction in one step, and shear until about this many nodes slip."""
    share = min(1.0 - (1.0 - events / contact) ** 2, SHEAR / (MU * PRESS)) if events < contact else SHEAR / (MU * PRESS)
    steps = [{"normal_force": PRESS, "friction": False}, {"tangential_force": share * MU * PRESS}]
    return Case(BODIES, steps, {"nodes": round(1.2 * contact)}, MU, coupling, BY_EVENTS)


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """Everything in this section."""
    contacts = CONTACTS[:4] if quick else CONTACTS
    cycle = [row for contact in contacts for row in _cost(bench, contact, "full", quick)]
    return stamp() | {
        "cycle": cycle,
        "families": {
            name: [row for contact in contacts if 80 <= contact <= 1000 for row in _little(bench, contact, keys["coupling"])]
            for name, keys in FAMILIES.items()
        },
        "memory": _memory(bench, contacts, cycle),
    }


def _cost(bench: Bench, contact: int, coupling: str, quick: bool) -> list[dict[str, Any]]:
    """Cost per event, of one cycle if affordable, else of a part of the first shear."""
    rows = []
    whole = [solver for solver in SOLVERS if contact <= WHOLE[solver]]
    if whole:
        case = cycles(contact, 1, coupling)
        results = bench.run([case.by(linear_solver=solver) for solver in whole], 1 if quick or contact > 100 else 3)
        rows += [_row(result, result["whole"], "press, cycle") for result in results]
    part = [solver for solver in SOLVERS if WHOLE[solver] < contact <= MOST[solver]]
    for solver in part:
        cases = [little(contact, number_of, coupling).by(linear_solver=solver) for number_of in (FEW, EVENTS[solver])]
        few, many = bench.run(cases)
        # The common cost, mainly the first factorisation, belongs to no event.
        counts = {key: many["last"][key] - few["last"][key] for key in many["last"]}
        rows.append(_row(many, counts, "part of a shear"))
    return rows


def _little(bench: Bench, contact: int, coupling: str) -> list[dict[str, Any]]:
    """Reduced and fft on the same part of a shear, with and without factorisation."""
    solvers = [solver for solver in ("reduced", "fft") if contact <= MOST[solver]]
    case = little(contact, EVENTS["fft"], coupling)
    results = bench.run([case.by(linear_solver=solver) for solver in solvers], 2 if contact < 2000 else 1)
    return [_row(result, result["last"], "part of a shear") for result in results]


def _row(result: dict[str, Any], counts: dict[str, Any], history: str) -> dict[str, Any]:
    events = max(counts["events"], 1)
    return plain(result) | {
        "history": history,
        "events": counts["events"],
        "solves": counts["solves"],
        "seconds": counts["seconds"] / events,
        "solve": counts["seconds"] / max(counts["solves"], 1),
        "iterations": counts["iterations"] / max(counts["solves"], 1),
        "products": counts["products"] / max(counts["solves"], 1),
    }


def _memory(bench: Bench, contacts: tuple[int, ...], cycle: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Peak memory of a process for pressing in one step and the first few slipping nodes."""
    # The largest cases ran in separate processes.
    rows = [row for row in cycle if row["solver"] == "reduced" and row["contact"] > 1.1 * WHOLE["reduced"]]
    for contact in contacts:
        for solver in SOLVERS:
            if contact > min(MOST[solver], WHOLE["reduced"] if solver == "reduced" else MOST[solver]):
                continue
            result = bench.process(little(contact, 2).by(linear_solver=solver), 1)
            rows.append({"solver": solver, "contact": result["contact"], "memory": result["memory"]})
    return rows


def fits(rows: list[dict[str, Any]], key: str = "seconds", least: int = 150) -> dict[str, tuple[float, float]]:
    """Exponent and factor of every solver, from `least` nodes in contact."""
    laws = {}
    for solver in SOLVERS:
        points = [(row["contact"], row[key]) for row in rows if row["solver"] == solver and row["contact"] >= least]
        if len(points) >= 2:
            laws[solver] = slope(*zip(*points, strict=True))
    return laws


def flops(row: dict[str, Any]) -> float:
    """Approximate floating-point operations of the linear algebra per event."""
    contact, solves = row["contact"], row["solves"] / max(row["events"], 1)
    if row["solver"] == "dgesv":
        return float(solves * 2.0 / 3.0 * (4.0 * contact) ** 3)
    if row["solver"] == "reduced":
        # An update and, each solve, a product with the inverse, 2 m^2 each, m up to twice the nodes in contact.
        return float((1.0 + solves) * 2.0 * (2.0 * contact) ** 2)
    length = 2.0 * row["nodes"]
    # A product is two complex transforms; so is, about, what preconditioning takes.
    return float(solves * row["products"] * 2.0 * 2.0 * 5.0 * length * np.log2(length))


def section(data: dict[str, Any], pictures: Path) -> str:
    """The text."""
    draw(data, pictures / "cost_per_event.png")
    rows = []
    for row in data["cycle"]:
        rows.append(
            [
                row["solver"],
                row["contact"],
                row["history"],
                row["events"],
                number(row["solves"] / max(row["events"], 1), 3),
                number(row["iterations"]) if row["iterations"] else "",
                number(row["products"]) if row["products"] else "",
                number(flops(row) / 1e6),
                duration(row["seconds"]),
                number(flops(row) / row["seconds"] / 1e9),
                f"{row['certificate']:.0e}",
            ]
        )
    laws = fits(data["cycle"])
    exponents = ", ".join(f"{solver} {exponent:.1f}" for solver, (exponent, _) in laws.items())
    memory = {
        (row["solver"], min(CONTACTS, key=lambda contact: abs(contact - row["contact"]))): row["memory"] for row in data["memory"]
    }
    contacts = sorted({contact for _, contact in memory})
    return f"""## What does an event cost?

A rigid cylinder on a half-plane, nu = 0.3, mu = {MU}, full coupling: pressed with friction, then a cycle of shear to {SHEAR / (MU * PRESS):g} of
the sliding limit, by events ("press, cycle"). Large cases are pressed without friction and sheared until some nodes slip ("part of a shear"), without the first
events and the first factorisation. Operations are estimated.

{table(["linear solver", "nodes in contact", "history", "events", "solves per event", "iterations", "products", "Mflop per event", "time per event", "Gflop/s", "certificate"], rows)}

![Time of an event over nodes in contact](pictures/cost_per_event.png)

The time grows with the nodes in contact to the power (from 150 nodes on): {exponents}. Peak memory of the process, of which the program itself is about 15 MB:

{table(["nodes in contact", *SOLVERS], [[contact, *(size(memory[solver, contact]) if (solver, contact) in memory else "" for solver in SOLVERS)] for contact in contacts])}

{family_text(data)}
"""


def family_text(data: dict[str, Any]) -> str:
    """Crossovers by coupling."""
    rows = []
    for name, family in data["families"].items():
        for row in family:
            if row["solver"] != "fft":
                continue
            other = [r for r in family if r["solver"] == "reduced" and r["contact"] == row["contact"]]
            rows.append(
                [
                    name,
                    row["contact"],
                    number(row["iterations"]),
                    duration(row["seconds"]),
                    duration(other[0]["seconds"]) if other else "",
                    number(other[0]["seconds"] / row["seconds"]) if other else "",
                ]
            )
    head = ["coupling", "nodes in contact", "iterations of fft", "fft, per event", "reduced, per event", "reduced/fft"]
    return f"""`auto` uses reduced up to these numbers of nodes in contact, and fft beyond (`solver_costs.f90`; a test compares). A matrix body always uses reduced.

{table(["", "full coupling", "Goodman", "none"], [[name, *map(_most, columns)] for name, columns in LIMITS.items()])}

Reduced against fft on the same short history (about {EVENTS["fft"]} nodes begin to slip), including the factorisation:

{table(head, rows)}"""


#: Crossovers in the library: full coupling, Goodman's, none.
LIMITS = {
    "events": ("coupled", "one_way", "apart"),
    "large increments, no friction": ("at_once_coupled", "at_once", "at_once"),
    "Dahl's law": ("bristles_coupled", "bristles", "bristles"),
}


def _most(structure: str) -> int:
    """The crossover in the library."""
    found = re.search(rf"most_{structure} = (\d+)", (ROOT / "src/algorithms/solvers/solver_costs.f90").read_text())
    assert found is not None
    return int(found[1])


def draw(data: dict[str, Any], path: Path) -> None:
    """Time over nodes in contact."""
    figure, axes = pyplot.subplots(figsize=(6, 4), layout="constrained")
    laws = fits(data["cycle"])
    for solver in SOLVERS:
        points = [(row["contact"], row["seconds"]) for row in data["cycle"] if row["solver"] == solver]
        name = f"{solver}, slope {laws[solver][0]:.1f}" if solver in laws else solver
        axes.loglog(*zip(*points, strict=True), "o-", label=name)
    axes.set_xlabel("nodes in contact")
    axes.set_ylabel("seconds an event")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
