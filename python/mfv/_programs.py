"""The programs of the library, as commands of the environment that the package is installed in."""

from __future__ import annotations

import functools
import os
import shutil
import signal
import sys
from pathlib import Path

from ._library import HOW_TO_BUILD, find_library
from .errors import LibraryNotFound


def find_program(name: str) -> Path:
    """Path of a program: that of the same build as the library, else one on the PATH. Raises LibraryNotFound."""
    try:
        beside = Path(find_library()).parents[1] / "bin" / name
    except (LibraryNotFound, IndexError):  # IndexError: a library of the system, known by its name alone
        beside = None
    if beside is not None and beside.is_file():
        return beside
    other = shutil.which(name)
    if other is None or Path(other).resolve() == Path(sys.argv[0]).resolve():  # a command of this package is not the program
        raise LibraryNotFound(None, f"the program {name} was not found; {HOW_TO_BUILD}")
    return Path(other)


def become(name: str, arguments: list[str]) -> None:
    """Replace this process by a program: its output, progress, signals and exit code are those of the command.

    Raises LibraryNotFound, OSError.
    """
    program = find_program(name)
    for ignored in (signal.SIGPIPE, signal.SIGXFSZ):  # by Python, and a program inherits what is ignored
        signal.signal(ignored, signal.SIG_DFL)
    try:
        os.execv(program, [name, *arguments])
    except OSError as error:  # without the name of the program
        raise OSError(error.errno, error.strerror, str(program)) from None


def _command(name: str) -> None:
    """A command of the environment. Exits with a message if there is no such program."""
    try:
        become(name, sys.argv[1:])
    except (LibraryNotFound, OSError) as error:
        sys.exit(f"{name}: {message_of(error)}")


def message_of(error: Exception) -> str:
    """The text of an error; of one of the system, file and reason without its number."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{os.fsdecode(error.filename)}: {error.strerror}"
    return str(error)


mfv_run = functools.partial(_command, "mfv_run")
mfv_conventional = functools.partial(_command, "mfv_conventional")
mfv_stress = functools.partial(_command, "mfv_stress")
