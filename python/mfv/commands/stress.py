"""mfv stress: compute stresses inside the bodies of a result. The command becomes the program mfv_stress."""

from __future__ import annotations

import argparse

from .shared import add_program

NAME, HELP, PROGRAM = "stress", "compute stresses inside the bodies of a result", "mfv_stress"

DESCRIPTION = "Compute stresses inside a body and add them to the result file: the program mfv_stress, with its options."
EXAMPLES = ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what the shell completes."""
    add_program(parser, PROGRAM, "RESULT.h5")
