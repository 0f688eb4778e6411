"""mfv study: solve many cases that differ in some values."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import target
from ..studies.executors import NAMES
from ..studies.namelist import check_study, keys_in_markdown, read_study
from ..studies.plan import SUFFIXES, Study, is_table
from .completion import complete_files, complete_words
from .shared import add_output, at_least, terminated_like_interrupted

if TYPE_CHECKING:
    import xarray

NAME, HELP = "study", "solve many cases that differ in some values"

DESCRIPTION = """\
Solve many cases that differ in some values, and write one table: dissipation, stiffness, stick ratios, shift of the
contact, peak tractions, outcome of each. A namelist file defines the study. This one has 3 x 10 x 3 cases of
examples/mindlin.nml:

  &sweep base='mindlin.nml' /
  &vary  key='friction%mu', values=0.3, 0.5, 0.7 /
  &vary  key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1,
         from=0.5e-4, to=2.5e-4, count=10, name='Q' /
  &vary  key='scene%coupling', values='full', 'goodman', 'none' /

Keys of one &vary change together, here forward and back; the last &vary changes fastest. Solved cases are saved beside
the table, in TABLE.sqlite: after an interruption the same command continues, and after values are added only the new
cases are solved. See docs/studies.md.
"""

EXAMPLES = """\
examples:
  mfv study study.nml --list              check it and list its cases
  mfv study study.nml                     solve it on all processors, write study.nc
  mfv study study.nml -o study.csv        one row per case, for a spreadsheet
  mfv study study.nml --case 17 > 17.nml  print case 17 for mfv_run
  mpiexec -n 64 python -m mpi4py.futures -m mfv study study.nml --executor mpi
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    file = parser.add_argument("file", type=Path, metavar="STUDY.nml", nargs="?", help="namelist file of the study")
    complete_files(file, "nml")
    add_output(parser, "FILE", "table to write: .nc or .h5 (NetCDF), .csv (default: STUDY.nc)")
    executor = parser.add_argument(
        "--executor",
        default="threads",
        metavar="NAME",
        help=f"{', '.join(NAMES)}, or dask:ADDRESS of a cluster (threads by default)",
    )
    complete_words(executor, lambda: NAMES)
    parser.add_argument(
        "--workers", type=at_least(1), metavar="N", help="number of cases at a time (default: number of processors)"
    )
    either = parser.add_mutually_exclusive_group()
    either.add_argument("--again", action="store_true", help="solve all cases again")
    either.add_argument("--so-far", action="store_true", help="solve nothing; write the table of the cases solved so far")
    parser.add_argument(
        "--estimate", action="store_true", help="also solve every case on coarser meshes, for error bars (twice the time)"
    )
    parser.add_argument("--list", action="store_true", help="check the study and list its cases; nothing is solved or written")
    parser.add_argument("--case", type=at_least(1), metavar="N", help="print case N, from 1, as a case for mfv_run")
    parser.add_argument("--keys", action="store_true", help="print every group and key of a study, as tables in Markdown")


def run(options: argparse.Namespace) -> int | None:
    """Print, list or solve. Raises OSError, ValueError."""
    if options.keys:
        print(keys_in_markdown())
        return None
    if options.file is None:
        raise ValueError("no study given; write 'mfv study STUDY.nml'")
    study = read_study(options.file)
    study.error_estimate = options.estimate
    if options.case is not None:
        print(study.text(options.case), end="")
        return None
    if not options.so_far:
        check_study(study)
    output = _output(study, options)
    if options.list:
        print(f"{options.file} is valid: {len(study)} cases, to be written to {output}")
        for number in range(1, len(study) + 1):
            print(f"case {number}: {study.describe(number)}")
        return None
    return _solve(study, output, options)


def _solve(study: Study, output: Path, options: argparse.Namespace) -> int | None:
    from ..studies.dataset import write  # here, since it imports xarray

    kept = output.with_suffix(".sqlite")
    if study.keeps_results:
        study.results, study.results_from = output.with_suffix(".cases"), output.parent
    if options.so_far:
        table = study.so_far(kept)
    else:
        try:
            with terminated_like_interrupted():
                table = study.run(
                    executor=options.executor, workers=options.workers, store=kept, again=options.again, progress=True
                )
        except KeyboardInterrupt:
            print(f"mfv: solved cases are saved in {kept}; repeat the command to continue", file=sys.stderr)
            raise
    write(table, output)
    print(f"{output}: {_counted(table)}")
    _print_warned(study, table)
    _print_refused(study, table)
    return None


def _output(study: Study, options: argparse.Namespace) -> Path:
    """The file of the table. Raises OSError, ValueError if it cannot be written or is a file other than a study's table."""
    usual = Path(study.file) if study.file else Path(options.file.stem + ".nc")
    path: Path = usual if options.output is None else options.output
    if path.suffix.lower() in SUFFIXES[:-1] and is_table(path):
        return path
    return target(options.output, usual, SUFFIXES, [options.file])


def _counted(table: xarray.Dataset) -> str:
    """The number of cases of every outcome."""
    outcomes = [
        f"{count} {name.removeprefix('cases_').replace('_', ' ')}"
        for name, count in table.attrs.items()
        if name.startswith("cases_") and name not in ("cases_done", "cases_flagged")
    ]
    missing = table.attrs["cases"] - table.attrs["cases_done"]
    return f"{table.attrs['cases']} cases: {', '.join([*outcomes, *([f'{missing} not solved'] if missing else [])])}"


def _print_warned(study: Study, table: xarray.Dataset) -> None:
    """Print how many cases have warnings, and the first with its warnings."""
    warned = [place for place, text in enumerate(table["warnings"].values.flat) if text]
    if not warned:
        return
    unresolved = sum(map(bool, table["unresolved"].values.flat))
    print(
        f"{len(warned)} of {table.attrs['cases']} cases have warnings, {unresolved} of them quantities that are not resolved: see the "
        "columns warnings and unresolved"
    )
    print(f"case {warned[0] + 1} ({study.describe(warned[0] + 1)}): {table['warnings'].values.flat[warned[0]]}")


def _print_refused(study: Study, table: xarray.Dataset) -> None:
    """Print the first cases with input errors, with their messages."""
    shown, several = zip(table["outcome"].values.flat, table["message"].values.flat), 5
    refused = [(number, why) for number, (outcome, why) in enumerate(shown, start=1) if outcome == "input error"]
    for number, why in refused[:several]:
        print(f"case {number} ({study.describe(number)}): {why}")
    if len(refused) > several:
        print(f"and {len(refused) - several} more: see the columns outcome and message")
