"""python -m mfv study: many cases that differ in some values."""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import target
from ..studies.executors import NAMES
from ..studies.namelist import check_study, keys_in_markdown, read_study
from ..studies.plan import SUFFIXES, Study, is_table
from .shared import add_output, at_least

if TYPE_CHECKING:
    import xarray

NAME, HELP = "study", "solve many cases that differ in some values"

DESCRIPTION = """\
Solve many cases that differ in some values, and write one table: dissipation, stiffness, stick ratios, shift of the
contact, peak tractions, outcome of each. What is varied in which case a text says; this is a whole one, of 3 x 10 x 3 cases
of examples/mindlin.nml:

  &sweep base='mindlin.nml' /
  &vary  key='friction%mu', values=0.3, 0.5, 0.7 /
  &vary  key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1,
         from=0.5e-4, to=2.5e-4, count=10, name='Q' /
  &vary  key='scene%coupling', values='full', 'goodman', 'none' /

Keys in one &vary move together, here forth and back; the last &vary runs fastest. Solved cases are kept beside the table, in
TABLE.sqlite: after Ctrl-C, or worse, the same command goes on where it was, and when values are added only the new cases are
solved. docs/studies.md has more.
"""

EXAMPLES = """\
examples:
  python -m mfv study study.nml --list               is it valid, which cases are there
  python -m mfv study study.nml                      all processors of this machine, into study.nc
  python -m mfv study study.nml -o study.csv         one row a case, for a spreadsheet
  python -m mfv study study.nml --case 17 > 17.nml   case 17 by itself, for mfv_run
  mpiexec -n 64 python -m mpi4py.futures -m mfv study study.nml --executor mpi
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the options."""
    parser.add_argument("file", type=Path, metavar="STUDY.nml", nargs="?", help="text of the study")
    add_output(parser, "FILE", "table to write: .nc or .h5 (NetCDF), .csv (default: STUDY.nc)")
    parser.add_argument(
        "--executor",
        default="threads",
        metavar="NAME",
        help=f"{', '.join(NAMES)}, or dask:ADDRESS of a cluster (threads)",
    )
    parser.add_argument("--workers", type=at_least(1), metavar="N", help="cases at a time (as many as processors)")
    either = parser.add_mutually_exclusive_group()
    either.add_argument("--again", action="store_true", help="solve all cases, those that are there already as well")
    either.add_argument("--so-far", action="store_true", help="solve nothing: write the table of the cases that are there")
    parser.add_argument("--list", action="store_true", help="say which cases there are; nothing is solved or written")
    parser.add_argument("--case", type=at_least(1), metavar="N", help="print case N, from 1, as a case for mfv_run")
    parser.add_argument("--keys", action="store_true", help="print every group and key of a study, as tables in Markdown")


def run(options: argparse.Namespace) -> int | None:
    """Carry the command out."""
    if options.keys:
        print(keys_in_markdown())
        return None
    if options.file is None:
        raise ValueError("the text of a study is missing, STUDY.nml")
    study = read_study(options.file)
    if options.case is not None:
        print(study.text(options.case), end="")
        return None
    if not options.so_far:
        check_study(study)
    output = _output(study, options)
    if options.list:
        print(f"{options.file} is valid: {len(study)} cases, into {output}")
        for number in range(1, len(study) + 1):
            print(f"case {number}: {study.describe(number)}")
        return None
    return _solve(study, output, options)


def _solve(study: Study, output: Path, options: argparse.Namespace) -> int | None:
    from ..studies.dataset import write  # here: it imports xarray

    kept = output.with_suffix(".sqlite")
    if study.keeps_results:
        study.results, study.results_from = output.with_suffix(".cases"), output.parent
    if options.so_far:
        table = study.so_far(kept)
    else:
        try:
            with _terminated_like_interrupted():
                table = study.run(
                    executor=options.executor, workers=options.workers, store=kept, again=options.again, progress=True
                )
        except KeyboardInterrupt:
            print(f"mfv: solved cases are kept in {kept}; the same command goes on", file=sys.stderr)
            raise
    write(table, output)
    print(f"{output}: {_counted(table)}")
    _print_what_could_not_begin(study, table)
    return None


def _output(study: Study, options: argparse.Namespace) -> Path:
    """Where the table goes. Raises OSError, ValueError where it cannot, or where there is something that is no study."""
    usual = Path(study.file) if study.file else Path(options.file.stem + ".nc")
    path: Path = usual if options.output is None else options.output
    if path.suffix.lower() in SUFFIXES[:-1] and is_table(path):
        return path
    return target(options.output, usual, SUFFIXES, [options.file])


class _terminated_like_interrupted:
    """SIGTERM, by which queues announce the end, does what Ctrl-C does."""

    def __enter__(self) -> None:
        self._before = signal.signal(signal.SIGTERM, signal.default_int_handler)

    def __exit__(self, *_: object) -> None:
        signal.signal(signal.SIGTERM, self._before)


def _counted(table: xarray.Dataset) -> str:
    """How many cases ended how."""
    told = [
        f"{count} {name.removeprefix('cases_').replace('_', ' ')}"
        for name, count in table.attrs.items()
        if name.startswith("cases_") and name != "cases_done"
    ]
    missing = table.attrs["cases"] - table.attrs["cases_done"]
    return f"{table.attrs['cases']} cases: {', '.join([*told, *([f'{missing} not solved'] if missing else [])])}"


def _print_what_could_not_begin(study: Study, table: xarray.Dataset) -> None:
    """The first cases whose values do not go together, with their messages."""
    shown, several = zip(table["outcome"].values.flat, table["message"].values.flat), 5
    refused = [(number, why) for number, (outcome, why) in enumerate(shown, start=1) if outcome == "input error"]
    for number, why in refused[:several]:
        print(f"case {number} ({study.describe(number)}): {why}")
    if len(refused) > several:
        print(f"and {len(refused) - several} more: see the columns outcome and message")
