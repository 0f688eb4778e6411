"""Targets: reduced against dgesv, a thousand nodes, ten thousand nodes."""

from __future__ import annotations

from typing import Any

import numpy as np
from events import cycles
from harness import Bench, duration, number, plain, size, stamp, table

SMALL, CYCLES = (85, 331), 4
WANTED = {85: 100.0, 331: 1000.0}
TRACTIONS = 1e-9
LARGE, LARGE_SECONDS = 1000, 60.0
HUGE, HUGE_SECONDS, HUGE_MEMORY = 10000, 1800.0, 500e6


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """Ratios in one run each, and the large one."""
    data = stamp() | {"pairs": [pair(bench, contact, 1 if quick and contact > 100 else CYCLES) for contact in SMALL]}
    case = cycles(LARGE, CYCLES)
    data["large"] = [plain(bench.run([case.by(linear_solver=solver)])[0]) for solver in ("reduced", "fft")]
    return data


def pair(bench: Bench, contact: int, number_of: int) -> dict[str, Any]:
    """The same case with dgesv and reduced, alternately in one process."""
    case = cycles(contact, number_of)
    repeats = 3 if contact < 100 else 1
    # The fast one is measured more often, since its relative scatter is larger.
    solvers = ["dgesv"] + ["reduced"] * 5
    results = bench.run([case.by(linear_solver=solver) for solver in solvers], repeats)
    slow, fast = results[0], min(results[1:], key=lambda result: result["whole"]["seconds"])
    a, b = slow["tractions"], fast["tractions"]
    largest = max(np.abs(a.pressure).max(), np.abs(a.shear).max())
    difference = max(np.abs(a.pressure - b.pressure).max(), np.abs(a.shear - b.shear).max()) / largest
    return {"cycles": number_of, "dgesv": plain(slow), "reduced": plain(fast), "difference": float(difference)}


def measure_long(bench: Bench) -> dict[str, Any]:
    """Ten thousand nodes, press and one cycle."""
    result = bench.process(cycles(HUGE, 1).by(linear_solver="fft"), 1)
    return stamp() | plain(result)


def section(data: dict[str, Any], long: dict[str, Any] | None) -> str:
    """The text."""
    rows = []
    for entry in data["pairs"]:
        slow, fast = entry["dgesv"], entry["reduced"]
        contact = fast["contact"]
        wanted = min(WANTED.items(), key=lambda item: abs(item[0] - contact))[1]
        rows.append(
            [
                f"{contact}, {entry['cycles']} cycles",
                f"{slow['whole']['events']} / {fast['whole']['events']}",
                f"{entry['difference']:.0e}",
                f"{slow['whole']['solves']} / {fast['whole']['solves']}",
                number(fast["whole"]["solves"] / fast["whole"]["events"], 3),
                duration(slow["whole"]["seconds"]),
                duration(fast["whole"]["seconds"]),
                f"**{slow['whole']['seconds'] / fast['whole']['seconds']:.0f}**",
                f"{wanted:.0f}",
            ]
        )
    head = [
        "nodes in contact",
        "events dgesv / reduced",
        "largest difference of final tractions",
        "solves",
        "solves per event",
    ]
    head += ["dgesv", "reduced", "ratio", "target"]
    large = [
        [
            row["solver"],
            row["contact"],
            row["whole"]["events"],
            row["whole"]["solves"],
            duration(row["whole"]["seconds"]),
            f"{row['certificate']:.0e}",
        ]
        for row in data["large"]
    ]
    best = min(row["whole"]["seconds"] for row in data["large"])
    text = f"""## Targets

Full coupling, pressed with friction, {CYCLES} cycles of shear (the scene of [events](#what-does-an-event-cost)). Tractions of dgesv and reduced must agree to {TRACTIONS:.0e} of the
largest traction. Numbers of events can differ where many nodes reach their limits at one load; the states agree:

{table(head, rows)}

A solve gives a state with its rates. An event takes one solve, or more if a neighbour changes its status at the same load, and at a reversal. With dgesv every solve is a
factorisation; with reduced it is a product with an updated inverse.

{LARGE} nodes, press and {CYCLES} cycles (target: {LARGE_SECONDS:.0f} s; measured: {duration(best)}):

{table(["linear solver", "nodes in contact", "events", "solves", "time", "certificate"], large)}
"""
    if long is None:
        return text
    whole = long["whole"]
    return (
        text
        + f"""
{HUGE} nodes, press and one cycle, fft (`--long`, measured {long["date"]}; target: less than {HUGE_SECONDS / 60:.0f} minutes and {size(HUGE_MEMORY)}):
{long["contact"]} nodes in contact, {whole["events"]} events, {whole["solves"]} solves, {whole["iterations"] / whole["solves"]:.1f} iterations per solve, {whole["seconds"] / 60:.1f} minutes, peak memory of the process
{size(long["memory"])}, certificate {long["certificate"]:.0e}.
"""
    )
