"""States between those that a result keeps, for commands that draw a load history."""

from __future__ import annotations

import argparse
import sys

from ..load_history import LoadHistory, with_states_between
from ..result import Result


def solved_between(options: argparse.Namespace, result: Result, states: int) -> LoadHistory:
    """About so many states of the load history of `options.file`; the way there is shown on a terminal, what there is to say of
    them goes to the standard error."""
    from tqdm import tqdm

    history = with_states_between(
        result, states, lambda targets: tqdm(targets, desc="solving", unit="state", disable=None)
    )
    if history.note:
        print(f"mfv: {options.file}: {history.note}", file=sys.stderr)
    return history
