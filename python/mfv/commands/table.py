"""python -m mfv table: the table of a sweep."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..table import read_table
from .files import TABLES, target, written

NAME, HELP = "table", "print the table of a sweep"

DESCRIPTION = """\
Describe the columns of a table of mfv_sweep: name, range of the values, unit, meaning; or write the table as
comma-separated values.
"""

EXAMPLES = """\
examples:
  python -m mfv table study.h5              what is in the columns
  python -m mfv table study.h5 --csv study.csv
                                            the table for a spreadsheet
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="STUDY.h5", help="file of mfv_sweep")
    parser.add_argument(
        "--csv",
        metavar="FILE",
        help="write comma-separated values; - for the standard output; else the columns are described",
    )


def run(options: argparse.Namespace) -> None:
    """Print or write. Raises OSError, NotAResult."""
    table = read_table(options.file)
    if options.csv is None:
        print(table.describe())
    elif options.csv == "-":
        table.write_csv(None)
    else:
        output = target(options.csv, options.file.with_suffix(".csv"), TABLES, [options.file])
        with written(output) as part:
            table.write_csv(part)
        print(output)
