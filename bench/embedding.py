"""Cost of advancing a contact from Python: time of `Case.advance` against that of the library for the same steps.

PYTHONPATH=python build/venv/bin/python bench/embedding.py

85 nodes in contact, Coulomb friction, cyclic shear in small increments of the shift. Measured alternately: `advance`;
`mfv_advance` called through ctypes with prepared steps; and the same function without a case, which returns at once and measures
the call and the clock. The second minus the third is the time of the library. Then the same with a query of the loads after every
increment. The minimum over all repeats of every increment is used, which excludes other programs on the machine.
"""

from __future__ import annotations

import argparse
import functools
import os
import sys
import time
from collections.abc import Callable
from ctypes import byref, c_void_p, sizeof
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

import numpy as np
from numpy.typing import NDArray

import mfv
from mfv._library import CONTROLS, LoadsStructure, StepStructure, library
from mfv.loads import MOTIONS

#: Increments of a cycle, the smallest steps first, and the amplitude of the shift [length].
INCREMENTS, AMPLITUDE = (400, 80, 40), 2.0e-4


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
    """The case at the beginning of the shear."""
    case = scene().contact()
    case.advance(normal_force=1.0e-3, friction=False, check=True)
    return case


def increments(count: int) -> list[float]:
    """Increments of the shift: up, down, and up to the start."""
    to_and_fro = np.concatenate(([0.0], AMPLITUDE * np.sin(2.0 * np.pi * np.arange(1, count + 1) / count)))
    return [float(increment) for increment in np.diff(to_and_fro)]


def durations(count: int, lead: Callable[[float], object]) -> NDArray[np.float64]:
    """Seconds of each increment."""
    taken = []
    for increment in increments(count):
        started = time.perf_counter()
        lead(increment)
        taken.append(time.perf_counter() - started)
    return np.array(taken)


def by_advance(count: int, loads: bool) -> NDArray[np.float64]:
    """`advance`; with `loads` followed by a query of the loads."""
    with pressed() as case:
        if loads:
            return durations(count, lambda shift: (case.advance(shift=shift, relative=True), case.loads))
        return durations(count, lambda shift: case.advance(shift=shift, relative=True))


def by_ctypes(count: int, with_case: bool, loads: bool) -> NDArray[np.float64]:
    """The functions of the library alone."""
    advance, get_loads = library().mfv_advance, library().mfv_get_loads
    steps = {shift: byref(_step(shift)) for shift in increments(count)}
    found = byref(LoadsStructure(size=sizeof(LoadsStructure)))
    with pressed() as case:
        handle = case._handle if with_case else c_void_p()
        if loads:
            return durations(count, lambda shift: (advance(handle, steps[shift]), get_loads(handle, found)))
        return durations(count, lambda shift: advance(handle, steps[shift]))


def _step(shift: float) -> StepStructure:
    motions = {motion.displacement: number for number, motion in enumerate(MOTIONS)}
    step = StepStructure(size=sizeof(StepStructure), friction=1, relative=1)
    step.control[motions["shift"]] = CONTROLS.index("DISPLACEMENT")
    step.target[motions["shift"]] = shift
    return step


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=40, help="number of measurements; the minimum is reported (40)")
    options = parser.parse_args()
    for count in INCREMENTS:
        print(f"{count} increments a cycle")
        for loads in (False, True):
            report(count, loads, options.repeats)


def report(count: int, loads: bool, repeats: int) -> None:
    """Measure alternately, and print the overhead of Python."""
    measures = {
        "package": functools.partial(by_advance, count, loads),
        "library": functools.partial(by_ctypes, count, True, loads),
        "nothing": functools.partial(by_ctypes, count, False, loads),
    }
    least = {name: np.full(count, np.inf) for name in measures}
    for _ in range(repeats):
        for name, measure in measures.items():
            least[name] = np.minimum(least[name], measure())
    package, library_and_call, call = (1e6 * float(np.mean(least[name])) for name in measures)
    own = library_and_call - call
    print(
        f"  {'advance and loads' if loads else 'advance':18}{package:7.2f} us, of which the library {own:.2f} us: "
        f"Python adds {100.0 * (package / own - 1.0):.1f} %"
    )


if __name__ == "__main__":
    main()
