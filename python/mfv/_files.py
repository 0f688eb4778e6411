"""Files that commands and studies write."""

from __future__ import annotations

import contextlib
import errno
import itertools
import os
import re
import shutil
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import h5py

#: Suffixes of pictures and of comma-separated values.
PICTURES, TABLES = (".png", ".pdf", ".svg", ".eps"), (".csv", ".txt")

#: Seconds after which a part of a process that is not on this machine, or no more, is taken for left behind.
_STALE_AGE = 3600.0


def target(given: Path | str | None, usual: Path, suffixes: Sequence[str], inputs: Sequence[Path]) -> Path:
    """Where a command is to write: what the user gave, or the usual place where that is None.

    `suffixes`: those that it may have, in small letters or capitals. `inputs`: the files that the command reads.
    Raises OSError and ValueError, with messages that name the place, where it cannot be written to or must not be: a
    directory, another suffix, one of the inputs, a file of HDF5, which is no such thing and may be a result.
    """
    path = usual if given is None else Path(given)
    if not path.name:
        raise ValueError(f"'{path}' is no name of a file to write; give one such as {usual.name}")
    if path.is_dir():
        raise IsADirectoryError(f"{path}: is a directory; give a file in it, such as {path / usual.name}")
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{path}: the name of what is written must end with {' or '.join(suffixes)}")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path}: there is no directory {path.parent} to write to")
    if any(path.exists() and source.exists() and path.samefile(source) for source in inputs):
        raise ValueError(f"{path}: is what is read; give another file to write")
    if path.is_file() and h5py.is_hdf5(path):
        raise ValueError(f"{path}: is HDF5, perhaps a result, and is not overwritten; give another file to write")
    return path


@contextlib.contextmanager
def written(path: Path) -> Iterator[Path]:
    """A path beside `path`, with the same suffix, to write to: it becomes `path` when the block ends and its bytes are on the
    disk, and is removed when the block fails, so that nothing half-written is left and what was there before stays.

    A symbolic link stays one, and a file keeps its mode. Parts that killed processes have left are removed when they are an
    hour old. Raises OSError. The library does the same for its files, in src/common/replacement.c.
    """
    place = Path(os.path.realpath(path))
    if place.exists() and not os.access(place, os.W_OK):
        raise PermissionError(f"{path}: is there and may not be written")
    _remove_left_parts(place)
    part = _new_part(place)
    try:
        yield part
        _bring_to_disk(part)
        if place.exists():
            shutil.copymode(place, part)
        part.replace(place)
        _bring_to_disk(place.parent)
    finally:
        part.unlink(missing_ok=True)


def _new_part(place: Path) -> Path:
    """A new empty file beside `place`, under a name that nobody has."""
    for number in itertools.count():
        part = place.with_name(f"{place.stem}.part{os.getpid()}{f'-{number}' if number else ''}{place.suffix}")
        with contextlib.suppress(FileExistsError):
            os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
            break
    return part


def _remove_left_parts(place: Path) -> None:
    """Remove parts of processes that are no more, when nothing has changed them for an hour."""
    of_process = re.compile(rf"{re.escape(place.stem)}\.part(\d+)(-\d+)?{re.escape(place.suffix)}")
    for part in place.parent.iterdir():
        match = of_process.fullmatch(part.name)
        if match and not _is_alive(int(match[1])):
            with contextlib.suppress(OSError):
                if time.time() - part.lstat().st_mtime > _STALE_AGE:
                    part.unlink()


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        pass
    return True


def _bring_to_disk(path: Path) -> None:
    """Have the disk take a file, or the entries of a folder, where the file system can do that."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except PermissionError:  # a folder, or a file, that may be written and not read
        return
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.ENOSYS):
            raise OSError(error.errno, f"{path}: cannot be brought to the disk: {error.strerror}") from error
    finally:
        os.close(descriptor)
