"""What it costs to lead a contact from Python: time of `Case.advance` against that of the library for the same steps.

PYTHONPATH=python build/venv/bin/python bench/embedding.py

85 nodes in contact, Coulomb's friction, sheared to and fro in small increments of the shift. Three times in turn: the whole of
`advance`; `mfv_advance` called through ctypes with steps made before; and the same function with no case, which returns at once
and tells what a call by ctypes costs by itself. The second less the third is the library's own time.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from ctypes import byref, c_void_p, sizeof
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

import mfv
import numpy as np
from mfv._library import Control, StepStructure, library

#: Increments of a cycle, and the shift that they go to and fro between [length].
INCREMENTS, AMPLITUDE = 400, 2.0e-4


def scene() -> mfv.Scene:
    """A rigid cylinder on a half-plane, pressed without friction: 85 nodes in contact."""
    return mfv.Scene(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
        mfv.Body.disk(0.25, rigid=True),
        mesh=mfv.Mesh(nodes=101, half_width=0.0127),
        friction=mfv.Friction.coulomb(0.7),
        coupling="goodman",
        output=mfv.Output(history="none", states="none"),
    )


def pressed() -> mfv.Case:
    """The case where the shear begins."""
    case = scene().contact()
    case.advance(normal_force=1.0e-3, friction=False, check=True)
    return case


def increments() -> list[float]:
    """Increments of the shift: up, down, up again to where it began."""
    to_and_fro = np.concatenate(([0.0], AMPLITUDE * np.sin(2.0 * np.pi * np.arange(1, INCREMENTS + 1) / INCREMENTS)))
    return [float(increment) for increment in np.diff(to_and_fro)]


def duration(lead: Callable[[float], object], cycles: int) -> float:
    """Seconds that an increment takes."""
    way = increments() * cycles
    started = time.perf_counter()
    for increment in way:
        lead(increment)
    return (time.perf_counter() - started) / len(way)


def by_advance(cycles: int, loads: bool = False) -> float:
    """The whole of `advance`; with `loads` also asking for the loads."""
    with pressed() as case:
        if loads:
            return duration(lambda shift: (case.advance(shift=shift, relative=True), case.loads), cycles)
        return duration(lambda shift: case.advance(shift=shift, relative=True), cycles)


def by_ctypes(cycles: int, with_case: bool) -> float:
    """The function of the library alone."""
    function = library().mfv_advance
    steps = {shift: byref(_step(shift)) for shift in increments()}
    with pressed() as case:
        handle = case._handle if with_case else c_void_p()
        return duration(lambda shift: function(handle, steps[shift]), cycles)


def _step(shift: float) -> StepStructure:
    return StepStructure(
        size=sizeof(StepStructure),
        tangential_control=Control.DISPLACEMENT,
        tangential_target=shift,
        friction=1,
        relative=1,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cycles", type=int, default=5, help="cycles of one measurement (5 unless told)")
    parser.add_argument("--repeats", type=int, default=7, help="measurements, of which the least counts (7 unless told)")
    options = parser.parse_args()
    measures: dict[str, Callable[[], float]] = {
        "advance": lambda: by_advance(options.cycles),
        "advance and loads": lambda: by_advance(options.cycles, loads=True),
        "mfv_advance": lambda: by_ctypes(options.cycles, with_case=True),
        "ctypes": lambda: by_ctypes(options.cycles, with_case=False),
    }
    least = dict.fromkeys(measures, float("inf"))
    for _ in range(options.repeats):
        for name, measure in measures.items():
            least[name] = min(least[name], measure())
    own = least["mfv_advance"] - least["ctypes"]
    print(f"{'library alone':20}{own * 1e6:8.2f} us an increment")
    for name in ("mfv_advance", "advance", "advance and loads"):
        print(f"{name:20}{least[name] * 1e6:8.2f} us, {100.0 * (least[name] / own - 1.0):5.1f} % more than the library alone")


if __name__ == "__main__":
    main()
