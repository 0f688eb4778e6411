"""CONTACT (Vollebregt) beside MFV: inputs for one row of long elements, runs, answers."""

from __future__ import annotations

import os
import re
import resource
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from harness import ENVIRONMENT
from numpy.typing import NDArray

#: Its program; with it, peer.py measures its rows anew.
PROGRAM = os.environ.get("MFV_CONTACT", "")
#: Length of an element across the plane, in half-widths: that of plane strain to 1e-6.
LENGTH = 1e3
#: Relative change at which iterations end: finer ones leave its errors as they are; with coupling, those of its load steps.
TOLERANCE, TOLERANCE_COUPLED = 1e-5, 1e-4
#: Most iterations: of conjugate gradients, of contact areas, of Newton's method, between normal and tangential problem.
LIMITS = "9999 999 100 1"
LIMITS_COUPLED = "9999 999 100 20"


@dataclass(frozen=True)
class Job:
    """Load steps (normal force, tangential force over mu P) on a parabola or on heights; coupled: below a rigid body, nu = 0."""

    window: float
    loads: tuple[tuple[float, float], ...]
    mu: float | None
    coupled: bool = False
    heights: NDArray[np.float64] | None = None

    def text(self, nodes: int, every_step: bool) -> str:
        """Its input. Tractions are written after every step or after the last."""
        limits = f"{LIMITS_COUPLED} {TOLERANCE_COUPLED:g}" if self.coupled else f"{LIMITS} {TOLERANCE:g}"
        lines = []
        for number, (normal, tangential) in enumerate(self.loads):
            # Digits of control: start or go on, no friction or a shift, forces given; new or kept data; output.
            first, output = number == 0, int(every_step or number == len(self.loads) - 1)
            lines += ["3 MODULE", f"{2 if first else 0}0{'010' if self.mu is None else '111'}0 PBTNFS"]
            lines += ["022020 LDCMZE", f"000{output}001 HGIAOWR", limits] if first else ["100000 LDCMZE", f"011{output}001 HGIAOWR"]
            lines += [f"{normal * LENGTH:.15g} {-tangential:.15g} 0 0"]
            if first:
                lines += [f"{self.mu or 1.0:g} {self.mu or 1.0:g}", "0 0 1e10 0.5" if self.coupled else "0.3 0.3 0.7 0.7", "1"]
                lines += [f"{nodes} 1 {-0.5 * self.window:g} {-0.5 * LENGTH:g} {self.window / nodes:.17g} {LENGTH:g}"]
                lines += ["1 1", "0.5 0 0 0 0 0"] if self.heights is None else ["9 1", *(f"{h:.12g}" for h in self.heights)]
        return "\n".join([*lines, "0 MODULE", ""])


@dataclass
class State:
    """Pressure, shear (in MFV's sense) and slip at the nodes at the end of a load step."""

    pressure: NDArray[np.float64]
    shear: NDArray[np.float64]
    slip: NDArray[np.float64]


def solve(job: Job, nodes: int, every_step: bool = False) -> tuple[float, list[State]]:
    """Processor time of the process, and the states that it wrote."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "job.inp").write_text(job.text(nodes, every_step))
        call = [PROGRAM, "2", "job"]
        started = children()
        done = subprocess.run(call, check=True, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT, cwd=folder, close_fds=False)
        seconds = children() - started
        if re.search("ERROR|WARNING", done.stdout):
            raise RuntimeError(done.stdout)
        return seconds, [_state(file, nodes) for file in sorted(Path(folder).glob("job.*.mat"))]


def _state(file: Path, nodes: int) -> State:
    """From a file with a line for each node in contact."""
    lines = file.read_text().rpartition("%")[2].splitlines()[1:]
    table = np.array([line.split()[:11] for line in lines], dtype=np.float64)
    columns = np.zeros((3, nodes))
    columns[:, table[:, 0].astype(int) - 1] = table[:, [4, 5, 10]].T
    return State(columns[0], -columns[1], columns[2])


def dissipation(states: list[State], width: float) -> float:
    """Work of the shear on the slip of all steps."""
    return float(sum(np.sum(np.abs(state.shear * state.slip)) for state in states) * width)


def children() -> float:
    """Processor time of all child processes that have ended; beside other work, wall time is no measure."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
