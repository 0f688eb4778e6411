"""Observers of a run: a callback of the user, a progress bar, and Ctrl-C."""

from __future__ import annotations

import atexit
import signal
import threading
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_void_p
from typing import Any, Callable

from ._library import OBSERVER, ProgressStructure, library
from .loads import Progress

#: Observers of runs in progress; and whether the interpreter is ending.
_leading: set[Observer] = set()
_ending = threading.Event()

BAR_FORMAT = "{percentage:3.0f}%|{bar}| {elapsed}<{remaining}{postfix}"


def progress_bar(**arguments: Any) -> Any:
    """A progress bar for a terminal or, if ipywidgets is installed, for a notebook; `arguments`: those of tqdm."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "IProgress not found")  # of tqdm in a notebook without ipywidgets
        from tqdm.auto import tqdm  # here, since it checks whether this is a notebook
    return tqdm(**arguments)


class Observer:
    """The observer of a case: forwards the progress to the callback and the bar, and stops the run on request."""

    def __init__(self, handle: c_void_p) -> None:
        #: Neither a callback nor a bar is set, and no observer is registered with the library.
        self.is_idle = True
        self.is_leading = False
        self._callback: Callable[[Progress], object] | None = None
        self._handle = handle
        self._bar: Any = None
        self._signals: list[tuple[Any, Any]] = []
        self._handler: Any = None
        self._raised: BaseException | None = None
        self._function = OBSERVER(self._tell)

    @property
    def is_wanted(self) -> bool:
        """Whether a callback or a bar is set, or a run is in progress."""
        return self._callback is not None or self._bar is not None or self.is_leading

    def tell(self, callback: Callable[[Progress], object] | None) -> None:
        """Set the callback."""
        self.refuse_while_leading()
        self._callback = callback
        self.is_idle = False

    def watch(self, function: Callable[..., int], *arguments: object) -> int:
        """Call a function that changes the loads, with the observer; return its status."""
        self.refuse_while_leading()
        library().mfv_observe(self._handle, self._function, None)
        self._signals, self._raised, self.is_leading, self.is_idle = [], None, True, False
        _leading.add(self)
        try:
            with self._signals_held():
                return function(*arguments)
        finally:
            self.is_leading = False
            _leading.discard(self)

    def rest(self, function: Callable[..., int], *arguments: object) -> int:
        """Remove the observer and call the function; return its status."""
        library().mfv_observe(self._handle, OBSERVER(), None)
        self.is_idle = True
        return function(*arguments)

    def raise_what_ended_it(self) -> None:
        """Raise the exception of the callback; handle a pending Ctrl-C, which usually raises."""
        raised, self._raised = self._raised, None
        signals, self._signals = self._signals, []
        for number, frame in signals[:1]:
            self._handler(number, frame)
        if raised is not None:
            raise raised

    def refuse_while_leading(self) -> None:
        """Raises RuntimeError in a callback, which must not use the case that calls it."""
        if self.is_leading:
            raise RuntimeError("a callback of observe must not use its case; use the callback's argument instead")

    @contextmanager
    def bar(self, wanted: bool) -> Iterator[None]:
        """Show the progress of a run, on a terminal or in a notebook."""
        if not wanted:
            yield
            return
        with progress_bar(total=1.0, disable=None, bar_format=BAR_FORMAT) as bar:
            self._bar, self.is_idle = None if bar.disable else bar, False
            try:
                yield
            finally:
                self._bar = None

    def _tell(self, progress: Any, _: object) -> int:
        """The function that the library calls; a value other than 0 ends the run."""
        if self._signals or _ending.is_set():
            return 1
        if not self.is_wanted:
            return 0
        try:
            told = Progress._make(ProgressStructure.unpack(progress.contents)[1:])  # without the size
            if self._bar is not None and self._bar.update(told.done - self._bar.n):
                self._bar.set_postfix_str(f"{told.contact_nodes} in contact, {told.stick_nodes} stuck", refresh=False)
            return int(self._callback is not None and bool(self._callback(told)))
        except BaseException as error:
            self._raised = error
            return 1

    @contextmanager
    def _signals_held(self) -> Iterator[None]:
        """Delay Ctrl-C until the run has ended because of it.

        Otherwise KeyboardInterrupt would be raised inside the callback, where Python reports and ignores it.
        """
        self._handler = signal.getsignal(signal.SIGINT)
        if threading.current_thread() is not threading.main_thread() or not callable(self._handler):
            yield
            return
        signal.signal(signal.SIGINT, lambda number, frame: self._signals.append((number, frame)))
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, self._handler)


def _end_runs() -> None:
    """Stop the runs of daemon threads before the interpreter ends, since it could no longer call their observers."""
    longest = 2.0
    _ending.set()
    started = time.monotonic()
    while _leading and time.monotonic() - started < longest:
        time.sleep(0.001)


atexit.register(_end_runs)
