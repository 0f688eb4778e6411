"""Arguments and functions that several commands share."""

from __future__ import annotations

import argparse
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from .._programs import find_program
from ..errors import LibraryNotFound
from ..load_history import LoadHistory, with_states_between
from ..result import Result
from .completion import IS_COMPLETING, complete_files


def at_least(least: int) -> Callable[[str], int]:
    """A type for argparse: a whole number of at least `least`."""

    def whole_number(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"must be a whole number of at least {least}, not '{text}'")
        return value

    return whole_number


def number(text: str) -> float:
    """A type for argparse: a number. Raises ArgumentTypeError."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number with a decimal point, such as 0.8, not '{text}'") from None


def add_output(parser: argparse.ArgumentParser, metavar: str, meaning: str) -> None:
    """Add the option for the file to write."""
    parser.add_argument("-o", "--output", type=Path, metavar=metavar, help=meaning)


def add_result(parser: argparse.ArgumentParser, name: str = "file", metavar: str = "RESULT.h5") -> None:
    """Add the argument for a result file."""
    complete_files(parser.add_argument(name, type=Path, metavar=metavar, help="result file"), "h5")


def add_program(parser: argparse.ArgumentParser, program: str, metavar: str) -> None:
    """Add what the shell completes of a command that becomes a program: files, and the options that its --help lists."""
    complete_files(parser.add_argument("file", metavar=metavar), Path(metavar).suffix[1:])
    if IS_COMPLETING:
        try:
            shown = subprocess.run([find_program(program), "--help"], capture_output=True, text=True).stdout
        except (LibraryNotFound, OSError):
            return
        for option in re.findall(r"^  (?:-\w, )?(--[a-z]+)", shown, re.MULTILINE):
            if option != "--help":
                parser.add_argument(option)


def solved_between(options: argparse.Namespace, result: Result, states: int) -> LoadHistory:
    """About `states` states of the load history of `options.file`, with a progress bar on a terminal and notes on standard error."""
    from tqdm import tqdm

    history = with_states_between(result, states, lambda targets: tqdm(targets, desc="solving", unit="state", disable=None))
    if history.note:
        print(f"mfv: {options.file}: {history.note}", file=sys.stderr)
    return history


class terminated_like_interrupted:
    """Treat SIGTERM, which batch systems send before the end of a job, like Ctrl-C."""

    def __enter__(self) -> None:
        self._before = signal.signal(signal.SIGTERM, signal.default_int_handler)

    def __exit__(self, *_: object) -> None:
        signal.signal(signal.SIGTERM, self._before)
