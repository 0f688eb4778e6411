"""The programs of the library, as commands of the environment that the package is installed in."""

from __future__ import annotations

import os
import sys
from pathlib import Path


def mfv_run() -> None:
    """Become mfv_run: solve a case."""
    _become("mfv_run")


def mfv_conventional() -> None:
    """Become mfv_conventional: solve a case by the conventional algorithm."""
    _become("mfv_conventional")


def mfv_stress() -> None:
    """Become mfv_stress: put the stresses inside a body into a result."""
    _become("mfv_stress")


def _become(name: str) -> None:
    """Replace this process by the program `name` of the package, with the arguments of this one."""
    program = Path(__file__).resolve().parent / "bin" / name
    if not program.is_file():
        sys.exit(f"{name}: there is no {program}: install mfv with 'pip install .', or a wheel")
    os.execv(program, [str(program), *sys.argv[1:]])
