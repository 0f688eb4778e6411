"""The command line of the package, `mfv COMMAND`: one module for each command."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from concurrent.futures import BrokenExecutor

from .. import __version__
from .._packages import how_to_install
from .._programs import become, message_of
from .._suggestions import suggestion
from ..errors import MfvError
from . import animate, compare, fatigue, identify, info, loads, map, new, plot, profile, report, run, stress, study
from .completion import complete

UNUSABLE = 2  # exit code for unusable input, the same as that of mfv_run
INTERRUPTED = 130  # exit code after Ctrl-C, the same as that of mfv_run

COMMANDS = (new, run, plot, info, stress, compare, animate, report, study, map, identify, profile, loads, fatigue)

#: Commands that are programs, with all their options.
PROGRAMS = {module.NAME: module.PROGRAM for module in (run, stress)}

EXAMPLES = """\
examples:
  mfv new                             write a commented case, cylinder.nml
  mfv run examples/mindlin.nml        write mindlin.h5
  mfv info mindlin.h5                 print its contents
  mfv plot mindlin.h5                 draw mindlin.png
  mfv compare goodman.h5 full.h5      compare two results
  mfv animate mindlin.h5              animate the load history, mindlin.gif
  mfv report mindlin.h5               write a web page, mindlin.html
  mfv study study.nml -o study.csv
                                      solve many cases, write one table
  mfv map examples/mindlin.nml        regimes over tangential and normal force
  mfv identify rig.nml loops.csv --free friction%mu=0.6
                                      parameters from measured loops
  mfv profile scan.x3p -o scan.txt    a measured profile as a text for &body
  mfv loads pad.frd --surface PAD     loads of a finite-element model for &history
  mfv fatigue tests.csv               fatigue tests and predicted lives

'mfv COMMAND --help' explains each command.
"""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    parser = _parser()
    complete(parser)
    words = sys.argv[1:] if arguments is None else arguments
    if not words:
        print(_overview())
        return 0
    names = [module.NAME for module in COMMANDS]
    if not words[0].startswith("-") and words[0] not in names:
        of_file = {".nml": "run", ".h5": "plot", ".nc": "info"}.get(os.path.splitext(words[0])[1])
        advice = f"; did you mean 'mfv {of_file} {words[0]}'?" if of_file else suggestion(words[0], names)
        parser.error(f"unknown command '{words[0]}'{advice}")
    if words[0] in PROGRAMS:
        return _as_program(PROGRAMS[words[0]], words[1:])
    options, unknown = parser.parse_known_args(arguments)
    if unknown:
        _refuse(options.parser, unknown[0])
    try:
        code: int = options.command(options) or 0
        _finish_output()
        return code
    except BrokenPipeError:  # the reader of the output has closed it, such as head
        _give_up_output()
        return UNUSABLE
    except (MfvError, OSError, ValueError) as error:
        print(f"mfv: {_with_file(message_of(error), options)}", file=sys.stderr)
        _give_up_output()
        return UNUSABLE
    except BrokenExecutor:
        print(
            "mfv: a process that solved cases has ended (out of memory, or killed?); solved cases are saved: repeat the command to "
            "continue, with fewer --workers if memory is short",
            file=sys.stderr,
        )
        return UNUSABLE
    except ModuleNotFoundError as error:
        text, package = str(error), str(error.name)
        if "is not installed" not in text:
            text = f"the Python package {package} is not installed: {how_to_install(package)}"
        print(f"mfv: {text}", file=sys.stderr)
        return UNUSABLE
    except Exception:
        traceback.print_exc()
        return UNUSABLE
    except KeyboardInterrupt:
        print("mfv: interrupted", file=sys.stderr)
        return INTERRUPTED


def _refuse(parser: argparse.ArgumentParser, word: str) -> None:
    """End a command because of a word that it does not know."""
    if not word.startswith("-"):
        parser.error(f"too many arguments: '{word}'")
    name = word.partition("=")[0]
    options = [text for action in parser._actions for text in action.option_strings if text.startswith("--") and text != "--help"]
    parser.error(f"unknown option '{name}'{suggestion(name, options)}")


def _as_program(program: str, arguments: list[str]) -> int:
    """Become a program; return the exit code if that fails."""
    try:
        become(program, arguments)
    except (MfvError, OSError) as error:
        print(f"mfv: {message_of(error)}", file=sys.stderr)
    return UNUSABLE


def _overview() -> str:
    """The commands, a line each, and how to begin; the manual page is made from it (docs/man)."""
    about = f"MFV {__version__}: two-dimensional frictional elastic contact. Help: mfv COMMAND --help"
    lines = ["usage: mfv COMMAND ...", "", about, "", "Commands:"]
    lines += [f"  {module.NAME:10}{module.HELP}" for module in COMMANDS]
    steps = ("mfv new cylinder.nml", "mfv run cylinder.nml")
    meanings = ("write a commented case", "solve it; mfv plot cylinder.h5 draws the result")
    lines += ["", "First steps:", *(f"  {step:26}{meaning}" for step, meaning in zip(steps, meanings))]
    return "\n".join(lines)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="mfv",
        description="Write and solve a case, look at its result, solve many cases that differ in some values.",
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
        if module.NAME not in PROGRAMS:
            command.set_defaults(command=module.run, parser=command)
    return parser


def _finish_output() -> None:
    """Flush standard output. Raises OSError; BrokenPipeError if its reader has closed it."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OSError(f"standard output cannot be written: {error.strerror}") from error


def _give_up_output() -> None:
    """Discard unprinted output, so that the interpreter does not try again at exit with its own message and exit code."""
    if sys.stdout is not None:
        try:
            sys.stdout.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _with_file(message: str, options: argparse.Namespace) -> str:
    """A message with the name of the input file, unless it names one of the command's files already."""
    values = (getattr(options, name, None) for name in ("file", "other", "output"))
    given = [str(value) for value in values if value]
    if not given or any(name in message for name in given):
        return message
    return f"{given[0]}: {message}"
