"""Exceptions.

In addition to those below there is one for every failure status of the library, named after its outcome:
`InputError` for "input error", `GrossSliding` for "gross sliding", and so on; `failures()` has them all. They are made
from the library's own list when first asked for.
"""

from __future__ import annotations

import functools


class MfvError(Exception):
    """Base of the exceptions of this package: a message, and the status of the library if there is one."""

    #: For an invalid axis of a study: its number from 0, and its invalid part.
    where: tuple[int, str] | None = None

    def __init__(self, status: int | None, message: str) -> None:
        super().__init__(status, message)
        self.status = status
        self.message = message

    def __str__(self) -> str:
        return self.message


class LibraryNotFound(MfvError, ImportError):
    """The shared library is missing or cannot be loaded."""


class NotAResult(MfvError):
    """A file is not a result file of MFV."""


@functools.cache
def failures() -> dict[int, type[MfvError]]:
    """The exceptions of the library's failing statuses, by status."""
    from ._library import statuses

    return {code: _exception(outcome, explanation) for code, outcome, explanation in statuses() if code != 0}


def failure(status: int, message: str) -> MfvError:
    """The exception of a failing status; an empty message is replaced by the explanation of the status."""
    kind = failures()[status]
    return kind(status, message or str(kind.__doc__))


def input_error(message: str) -> MfvError:
    """The InputError with a message."""
    return _named("InputError", message)


def file_error(message: str) -> MfvError:
    """The FileError with a message."""
    return _named("FileError", message)


def _named(name: str, message: str) -> MfvError:
    """The exception of a name, with the status that it stands for."""
    return failure(next(status for status, kind in failures().items() if kind.__name__ == name), message)


def _exception(outcome: str, explanation: str) -> type[MfvError]:
    name = "".join(word.capitalize() for word in outcome.split())
    return type(name, (MfvError,), {"__doc__": explanation, "__module__": __name__})


def __dir__() -> list[str]:
    """All names, including the exceptions of the statuses if the library is available."""
    try:
        kinds = [kind.__name__ for kind in failures().values()]
    except LibraryNotFound:
        kinds = []
    return sorted({*globals(), *kinds})


def __getattr__(name: str) -> type[MfvError]:
    if not name.startswith("_"):
        for kind in failures().values():
            if kind.__name__ == name:
                return kind
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
