"""The command line of the package, `python -m mfv COMMAND`: one module a command."""

from __future__ import annotations

import argparse
import os
import sys
import traceback

from .. import __version__
from .._packages import how_to_install
from ..errors import MfvError
from . import animate, compare, info, new, plot, report, study

UNUSABLE = 2  # exit code, as that of mfv_run for input that cannot be used
INTERRUPTED = 130  # exit code after Ctrl-C, as that of mfv_run

COMMANDS = (new, plot, info, compare, animate, report, study)

EXAMPLES = """\
examples:
  python -m mfv new                         write a commented case, cylinder.nml
  mfv_run examples/mindlin.nml              write mindlin.h5
  python -m mfv info mindlin.h5             what is in it
  python -m mfv plot mindlin.h5             draw mindlin.png
  python -m mfv compare goodman.h5 full.h5  two results side by side
  python -m mfv animate mindlin.h5          the load history as mindlin.gif
  python -m mfv report mindlin.h5           a web page of it, mindlin.html
  python -m mfv study study.nml -o study.csv
                                            solve many cases, into one table

python -m mfv COMMAND --help tells more about each.
"""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    options = _parser().parse_args(arguments)
    try:
        code: int = options.command(options) or 0
        _finish_output()
        return code
    except BrokenPipeError:  # whoever read the output has had enough
        _give_up_output()
        return UNUSABLE
    except (MfvError, OSError, ValueError) as error:
        print(f"mfv: {_with_file(str(error), options)}", file=sys.stderr)
        _give_up_output()
        return UNUSABLE
    except ModuleNotFoundError as error:
        package = str(error.name)
        print(f"mfv: this needs the Python package {package}, which is not there: {how_to_install(package)}", file=sys.stderr)
        return UNUSABLE
    except Exception:
        traceback.print_exc()
        return UNUSABLE
    except KeyboardInterrupt:
        print("mfv: interrupted", file=sys.stderr)
        return INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m mfv",
        description="Begin a case, look at result files of mfv_run, solve many cases that differ in some values.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"mfv {__version__}")
    commands = parser.add_subparsers(required=True, metavar=" | ".join(module.NAME for module in COMMANDS))
    for module in COMMANDS:
        command = commands.add_parser(
            module.NAME,
            help=module.HELP,
            description=module.DESCRIPTION,
            epilog=module.EXAMPLES,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_arguments(command)
        command.set_defaults(command=module.run)
    return parser


def _finish_output() -> None:
    """Print what is still to be printed. Raises OSError, BrokenPipeError where somebody has had enough of it."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OSError(f"standard output cannot be written: {error.strerror}") from error


def _give_up_output() -> None:
    """What could not be printed is not tried again when the interpreter ends, which would have its own words and exit code."""
    if sys.stdout is not None:
        try:
            sys.stdout.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _with_file(message: str, options: argparse.Namespace) -> str:
    """A message that names the file it is about: the one that was read, unless it names one of those given already."""
    values = (getattr(options, name, None) for name in ("file", "other", "output"))
    given = [str(value) for value in values if value]
    if not given or any(name in message for name in given):
        return message
    return f"{given[0]}: {message}"
