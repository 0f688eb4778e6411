"""What several commands take and do."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from ..load_history import LoadHistory, with_states_between
from ..result import Result


def at_least(least: int) -> Callable[[str], int]:
    """What reads a whole number that is not below `least`, for argparse."""

    def whole_number(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"a whole number of at least {least} is wanted, not '{text}'")
        return value

    return whole_number


def add_output(parser: argparse.ArgumentParser, metavar: str, meaning: str) -> None:
    """The option that says where to write."""
    parser.add_argument("-o", "--output", type=Path, metavar=metavar, help=meaning)


def solved_between(options: argparse.Namespace, result: Result, states: int) -> LoadHistory:
    """About so many states of the load history of `options.file`; the way there is shown on a terminal, what there is to say of
    them goes to the standard error."""
    from tqdm import tqdm

    history = with_states_between(result, states, lambda targets: tqdm(targets, desc="solving", unit="state", disable=None))
    if history.note:
        print(f"mfv: {options.file}: {history.note}", file=sys.stderr)
    return history
