"""mfv run: solve a case. The command becomes the program mfv_run."""

from __future__ import annotations

import argparse

from .shared import add_program

NAME, HELP, PROGRAM = "run", "solve a case", "mfv_run"

DESCRIPTION = "Solve a case, write its result file and print a summary: the program mfv_run, with its options."
EXAMPLES = ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what the shell completes."""
    add_program(parser, PROGRAM, "CASE.nml")
