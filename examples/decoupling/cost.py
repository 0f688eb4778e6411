"""Cost of a coupling: the disk in its hole, pressed with friction, four cycles of Q = 0.65 mu P, as a table in Markdown.

    python examples/decoupling/cost.py [NODES ...]

Times are the least of three runs in this process, over that of full coupling. The dissipation is over that of the same
coupling with events.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import mfv

CASE = Path(__file__).resolve().parent / "cases" / "hole_050.nml"
LINES = (("full", "event"), ("full", "leap"), ("goodman", "event"), ("none", "event"), ("none", "leap"))


def timed(text: str) -> tuple[float, mfv.Result]:
    """Least time of three runs in seconds, and the result."""
    times = []
    for _ in range(3):
        start = time.perf_counter()
        result = mfv.run(text=text)
        times.append(time.perf_counter() - start)
    return min(times), result


def main() -> None:
    case = CASE.read_text(encoding="utf-8")
    print("| nodes of the mesh | coupling | stepping | events | solves | ms | over `full` | dissipation over events' less 1 |")
    print("| ---: | --- | --- | ---: | ---: | ---: | ---: | ---: |")
    for nodes in [int(argument) for argument in sys.argv[1:]] or [195, 781]:
        whole, by_events = None, {}
        for coupling, stepping in LINES:
            text = case.replace("coupling='full'", f"coupling='{coupling}'").replace("nodes=195", f"nodes={nodes}")
            seconds, result = timed(text + f"&solver stepping='{stepping}'{', accuracy=1e-3' * (stepping == 'leap')} /\n")
            whole = whole or seconds
            energy = float(result.observables.dissipation_number)
            difference = energy / by_events.setdefault(coupling, energy) - 1.0
            summary = result.summary
            print(
                f"| {nodes} | `{coupling}` | '{stepping}' | {int(summary.events)} | {int(summary.linear_solves)} "
                f"| {1e3 * seconds:.0f} | {seconds / whole:.2f} | {difference:.1e} |"
            )


if __name__ == "__main__":
    main()
