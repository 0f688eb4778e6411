"""Files that commands and studies write."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

import h5py

#: Suffixes of pictures.
PICTURES = (".png", ".pdf", ".svg", ".eps")

#: Numbers for the names of temporary files, which differ between threads.
_numbers = itertools.count()


def target(given: Path | str | None, usual: Path, suffixes: Sequence[str], inputs: Sequence[Path]) -> Path:
    """The file that a command writes: `given`, or `usual` if that is None.

    `suffixes`: the allowed ones, in lower or upper case. `inputs`: the files that the command reads. Raises OSError and
    ValueError for a directory, another suffix, one of the inputs, and an existing HDF5 file, which may be a result.
    """
    path = usual if given is None else Path(given)
    if not path.name:
        raise ValueError(f"'{path}' is not a file name; give one such as {usual.name}")
    if path.is_dir():
        raise IsADirectoryError(f"{path}: is a directory; give a file, such as {path / usual.name}")
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{path}: the file name must end with {' or '.join(suffixes)}")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: {path.parent} does not exist or is not a directory")
    if any(path.exists() and source.exists() and path.samefile(source) for source in inputs):
        raise ValueError(f"{path}: is the input file; choose another file name")
    if path.is_file() and h5py.is_hdf5(path):
        raise ValueError(f"{path}: is an HDF5 file, not overwritten; choose another file name")
    return path


@contextlib.contextmanager
def written(path: Path) -> Iterator[Path]:
    """A temporary file beside `path`, with the same suffix. At the end of the block it is flushed to disk and renamed to `path`; if
    the block fails it is removed, and an existing file is unchanged.

    Symbolic links and file modes are preserved. Raises OSError.
    """
    place = Path(os.path.realpath(path))
    if place.exists() and not os.access(place, os.W_OK):
        raise PermissionError(f"{path}: exists and is read-only")
    part = place.with_name(f"{place.stem}.part{os.getpid()}-{next(_numbers)}{place.suffix}")
    part.touch()
    try:
        yield part
        with part.open("rb") as file:
            os.fsync(file.fileno())
        if place.exists():
            shutil.copymode(place, part)
        part.replace(place)
    finally:
        part.unlink(missing_ok=True)
