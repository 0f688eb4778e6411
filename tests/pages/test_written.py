"""Files that Python's commands write: the old or the new one is complete after any failure; tests/cli/test_files.py has the programs."""

from __future__ import annotations

import errno
import os
import threading
from pathlib import Path

import pytest

from mfv._files import written


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A file that is there."""
    path = tmp_path / "picture.png"
    path.write_text("old")
    return path


def test_a_file_is_on_the_disk_before_it_has_its_name(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []
    real_fsync, real_replace = os.fsync, Path.replace

    def fsync(descriptor: int) -> None:
        order.append("fsync " + os.path.basename(os.readlink(f"/proc/self/fd/{descriptor}")))
        real_fsync(descriptor)

    def replace(source: Path, target: Path) -> Path:
        order.append(f"rename {source.name}")
        return real_replace(source, target)

    monkeypatch.setattr(os, "fsync", fsync)
    monkeypatch.setattr(Path, "replace", replace)
    with written(place) as part:
        part.write_text("new")
    assert order == [f"fsync {part.name}", f"rename {part.name}"]
    assert place.read_text() == "new" and list(place.parent.iterdir()) == [place]


@pytest.mark.parametrize("owner, name", [(os, "fsync"), (Path, "replace")])
def test_what_fails_leaves_the_old_file_and_no_part(owner: object, name: str, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(owner, name, fail)
    with pytest.raises(OSError, match="No space left on device"), written(place) as part:
        part.write_text("new")
    monkeypatch.undo()
    assert place.read_text() == "old" and list(place.parent.iterdir()) == [place]


def test_a_block_that_fails_leaves_the_old_file_and_no_part(place: Path) -> None:
    with pytest.raises(ZeroDivisionError), written(place) as part:
        part.write_text("half")
        raise ZeroDivisionError
    assert place.read_text() == "old" and list(place.parent.iterdir()) == [place]


def test_two_threads_write_under_two_names(place: Path) -> None:
    meet = threading.Barrier(2)
    names: set[Path] = set()

    def write(text: str) -> None:
        with written(place) as part:
            meet.wait(10.0)
            names.add(part)
            part.write_text(text)

    threads = [threading.Thread(target=write, args=(text,)) for text in ("one", "another")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(names) == 2 and place.read_text() in ("one", "another") and list(place.parent.iterdir()) == [place]


def test_links_and_modes_stay(place: Path) -> None:
    real = place.with_name("real.png")
    place.rename(real)
    place.symlink_to("real.png")
    real.chmod(0o640)
    with written(place) as part:
        part.write_text("new")
    assert place.is_symlink() and real.read_text() == "new" and real.stat().st_mode & 0o777 == 0o640
