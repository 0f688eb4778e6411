"""The programs of the library, as commands of the environment that the package is installed in."""

from __future__ import annotations

import functools
import os
import sys
from pathlib import Path


def _become(name: str) -> None:
    """Replace this process by the program `name` of the package, with the arguments of this one."""
    program = Path(__file__).resolve().parent / "bin" / name
    if not program.is_file():
        sys.exit(f"{name}: {program} not found; install mfv with 'pip install .' or from a wheel")
    os.execv(program, [str(program), *sys.argv[1:]])


mfv_run = functools.partial(_become, "mfv_run")
mfv_conventional = functools.partial(_become, "mfv_conventional")
mfv_stress = functools.partial(_become, "mfv_stress")
