"""Base cases of a study: scenes and namelist files, the files that these name, their units."""

from __future__ import annotations

import errno
import os
import re
from pathlib import Path
from typing import Any, Union

import numpy as np

from ..errors import input_error
from ..inputs import groups
from ..inputs import keys as keys_of_text
from ..scene import _NAMES_OF_DATA, Scene
from .cases import FILE_KEYS, Base, base_text

#: A scene, or the path of a namelist file.
Given = Union[Scene, str, "os.PathLike[str]", Base]


def text_of_file(path: str | os.PathLike[str]) -> str:
    """The text of a regular file; the library rejects invalid UTF-8. Raises OSError."""
    if os.path.exists(path) and not os.path.isfile(path):  # reading a pipe or a device may not end
        raise OSError(errno.EINVAL, f"{os.fspath(path)}: not a regular file")
    content = Path(path).read_bytes()
    if b"\0" in content:
        raise OSError(errno.EINVAL, f"{os.fspath(path)}: not a text file; it contains a null character")
    return os.fsdecode(content)


def base_of(given: Given) -> Base:
    """A base case. Raises OSError, InputError, TypeError."""
    if isinstance(given, Base):
        return given
    if not isinstance(given, Scene):
        if not isinstance(given, (str, os.PathLike)):
            raise TypeError(f"must be a mfv.Scene or the path of a case, not {given!r}")
        name = os.fspath(given)
        if "&" in name and not os.path.exists(name):
            raise input_error("the base is the text of a case, not its path: give a Scene, such as Scene.from_text(text)")
        return Base(text_of_file(name), name, folder=os.path.dirname(name))
    data = []
    for group, part in given._parts():
        arrays = getattr(part, "data", None) or {}
        file = os.fspath(part.keys().get("file" if group.startswith("body") else "mu_file", _NAMES_OF_DATA.get(group, "")))
        data += [(file, name, np.ascontiguousarray(values, dtype=float)) for name, values in arrays.items()]
    return Base(given.text(), given.name, tuple(data), os.path.dirname(given.name))


def whole_paths(base: Base) -> dict[str, str]:
    """The absolute paths of the files that a base names, for workers in other directories. Raises InputError."""
    text = base_text(base)
    if "file" not in text:  # reading the keys takes longer than a small case
        return {}
    named = keys_of_text(text)
    in_memory = {file for file, _, _ in base.data}
    return {
        key: absolute(named[key], base)
        for key in FILE_KEYS
        if isinstance(named.get(key), str) and named[key] and named[key] not in in_memory
    }


def absolute(file: Any, base: Base) -> Any:
    """The absolute path of a file that a case names."""
    return os.path.join(os.path.abspath(base.folder), file) if isinstance(file, str) and file else file


def units_of(base: Base) -> dict[str, str]:
    """The names of length and force in a base. Raises InputError."""
    named = dict(re.findall(r"\b(length|force)_unit='([^']*)'", base_text(base)))
    return {unit: named.get(unit, unit) for unit in ("length", "force")}


def counts_of_groups(base: Base) -> dict[str, int]:
    """The number of groups of each name in a base. Raises InputError."""
    names = [name for name, _ in groups(base_text(base))]
    return {name: names.count(name) for name in names}
