"""Solved cases in an SQLite file, so that a study can continue after an interruption."""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
from collections.abc import Collection, Iterator

import numpy as np

from .. import errors
from .cases import Solved

#: "MFVS", the application_id of SQLite files of this module.
APPLICATION = 0x4D465653


class Store:
    """Solved cases by their hashes (mfv.studies.cases.digest), one row each: `key`, `solved` (JSON), `arrays` (the real numbers of
    all fields one after another, little-endian; `sizes` in `solved` has the number of values of each).

    Only one process can open the file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Raises FileError if the file cannot be used, belongs to another program, or is in use."""
        self.path = os.fspath(path)
        with self._named_in_errors():
            self._connection = sqlite3.connect(self.path, isolation_level=None, timeout=0.0)
            self._open()

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def read(self, keys: Collection[str]) -> dict[str, Solved]:
        """The saved ones of the cases with these hashes. Raises FileError."""
        with self._named_in_errors():
            rows = self._connection.execute("SELECT key, solved, arrays FROM cases")
            return {key: _solved(text, arrays) for key, text, arrays in rows if key in keys}

    def write(self, key: str, solved: Solved) -> None:
        """Save a case permanently. Raises FileError, for example on a full disk."""
        row = key, _text(solved), _bytes(solved)
        with self._named_in_errors():
            self._connection.execute("INSERT OR REPLACE INTO cases VALUES (?, ?, ?)", row)

    def clear(self) -> None:
        """Delete all cases. Raises FileError."""
        with self._named_in_errors():
            self._connection.execute("DELETE FROM cases")

    def _open(self) -> None:
        """Open exclusively, with a write-ahead log that survives a kill."""
        execute = self._connection.execute
        execute("PRAGMA locking_mode = EXCLUSIVE")
        application = execute("PRAGMA application_id").fetchone()[0]
        if application != APPLICATION and execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
            raise sqlite3.DatabaseError("it belongs to another program; not changed")
        execute("PRAGMA journal_mode = WAL")
        execute("PRAGMA synchronous = NORMAL")
        execute("BEGIN IMMEDIATE")
        execute(f"PRAGMA application_id = {APPLICATION}")
        execute("CREATE TABLE IF NOT EXISTS cases (key TEXT PRIMARY KEY, solved TEXT NOT NULL, arrays BLOB) WITHOUT ROWID")
        execute("COMMIT")

    @contextlib.contextmanager
    def _named_in_errors(self) -> Iterator[None]:
        """Raises FileError, which names the file, for errors of SQLite and damaged rows."""
        try:
            yield
        except (sqlite3.Error, ValueError, KeyError) as error:
            why = "another study is using it" if "locked" in str(error) else error
            raise errors.file_error(f"{self.path}: cannot save solved cases: {why}") from None


def _text(solved: Solved) -> str:
    """The saved results without the arrays."""
    kept = {name: value for name, value in vars(solved).items() if name != "arrays"}
    kept["sizes"] = {path: values.size for path, values in solved.arrays.items()}
    return json.dumps(kept)


def _bytes(solved: Solved) -> bytes | None:
    if not solved.arrays:
        return None
    return np.concatenate(list(solved.arrays.values())).astype("<f8").tobytes()


def _solved(text: str, arrays: bytes | None) -> Solved:
    kept = json.loads(text)
    kept["about"] = {path: tuple(about) for path, about in kept["about"].items()}
    sizes = kept.pop("sizes")
    solved = Solved(**kept)
    if arrays is not None:
        parts = np.split(np.frombuffer(arrays, "<f8").astype(float), np.cumsum(list(sizes.values()))[:-1])
        solved.arrays = dict(zip(sizes, parts))
    return solved
