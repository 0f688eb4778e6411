"""Completion in the shell, by argcomplete where it is installed: eval "$(register-python-argcomplete mfv)"."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable

#: Set by the shell function of argcomplete while it asks for completions.
IS_COMPLETING = "_ARGCOMPLETE" in os.environ


def complete(parser: argparse.ArgumentParser) -> None:
    """Print completions and exit if the shell asks for them; else do nothing."""
    if IS_COMPLETING:
        try:
            import argcomplete
        except ImportError:
            return
        argcomplete.autocomplete(parser)


def complete_files(argument: argparse.Action, *suffixes: str) -> None:
    """Complete an argument with the files of some suffixes (without dots) and with directories."""
    if IS_COMPLETING:
        try:
            from argcomplete.completers import FilesCompleter
        except ImportError:
            return
        argument.completer = FilesCompleter(suffixes)  # type: ignore[attr-defined]


def complete_words(argument: argparse.Action, words: Callable[[], Iterable[str]]) -> None:
    """Complete an argument with one of some words."""
    if IS_COMPLETING:
        argument.completer = lambda **_: list(words())  # type: ignore[attr-defined]
