"""A study as a namelist text (&sweep and &vary), with errors by file, line, group, key and value."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

from .. import errors
from .._suggestions import suggestion
from ..errors import input_error
from ..inputs import groups
from ..scene import _scene_handle, _text_of_scene
from .axes import Coordinate, Dimension, as_written
from .bases import text_of_file, whole_paths
from .cases import DUNDURS_BETA, Base, check, key_info
from .plan import Study

#: The largest numbers of values of an axis and of cases of a study.
MOST_VALUES, MOST_CASES = 100_000, 10_000_000


@dataclass(frozen=True)
class Key:
    """A key: its kind of values, its default, and its meaning."""

    kind: str
    default: str
    meaning: str
    is_list: bool = False


#: Every group and key of a study.
KEYS: dict[str, dict[str, Key]] = {
    "sweep": {
        "base": Key("text", "", "case file or files to vary, relative to the directory of the study; required", True),
        "file": Key("text", "", "file of the table (.nc, .h5 or .csv); the option -o overrides it; if omitted: the name of the study with .nc"),
        "combine": Key(
            "all paired", "all", "all combinations of the values, those of the last &vary fastest; or paired: the first of "
            "each, the second of each, ..."
        ),
        "states": Key(
            "none all", "none", "all: the result file of every case is also saved, in the folder of the table with .cases in "
            "place of its suffix"
        ),
        "reference": Key(
            "text", "none", "'full': every case is compared with the case that differs only in having full coupling; "
            "'KEY=VALUE', such as 'mesh%nodes=1001': with the case of this value; needs a &vary of the key with this value"
        ),
    },
    "vary": {
        "key": Key(
            "text", "", "key of the case, such as 'friction%mu' or 'step(2)%normal_force', or several that change together; "
            "'dundurs_beta': the materials of both bodies; required", True
        ),
        "factor": Key("number", "", "factor of the value, one for each key; if omitted: 1", True),
        "values": Key("any", "", "the values, in the unit of the key", True),
        "from": Key("number", "", "in place of values: the first of a sequence of numbers"),
        "to": Key("number", "", "its last"),
        "count": Key("whole", "", f"number of values, from 1 to {MOST_VALUES}"),
        "spacing": Key("linear log", "linear", "constant difference or constant ratio of neighbours"),
        "name": Key("text", "", "name of the column in the table; if omitted: the first key as written"),
    },
}  # fmt: skip

_KINDS = {
    "text": "a text between quotes",
    "number": "a number",
    "whole": "a whole number",
    "any": "as for the varied key",
}


def read_study(path: str | os.PathLike[str]) -> Study:
    """The study in a namelist file. Raises OSError; InputError, which names file, line, group, key and value."""
    return _Reader(os.fspath(path), text_of_file(path)).study()


def check_study(study: Study) -> None:
    """`Study.check` of a study that was read, with the line of the value in its message. Raises InputError."""
    try:
        study.check()
    except errors.InputError as error:
        reader = _Reader(study.input_file, study.input)
        reader.pass_on(error, several_bases=len(study.bases) > 1)


def keys_in_markdown() -> str:
    """Every group and key, as tables."""
    lines = []
    for group, keys in KEYS.items():
        lines += [f"### &{group}{' (may occur several times)' if group == 'vary' else ''}", ""]
        lines += ["| key | value | default | meaning |", "| --- | --- | --- | --- |"]
        for name, key in keys.items():
            value = _wanted(key) if not key.is_list else f"{_wanted(key)}, or several"
            lines.append(f"| `{name}` | {value} | {f'`{key.default!r}`' if key.default else '-'} | {key.meaning} |")
        lines.append("")
    return "\n".join(lines)


def _wanted(key: Key) -> str:
    """The kind of values of a key, as text."""
    return _KINDS.get(key.kind) or " or ".join(f"'{word}'" for word in key.kind.split())


@dataclass
class _Group:
    """A group of the text: its line, and lines and values of its keys."""

    name: str
    line: int
    lines: dict[str, int] = field(default_factory=dict)
    twice: list[str] = field(default_factory=list)
    values: dict[str, list[Any]] = field(default_factory=dict)


class _Reader:
    """The parser of a study."""

    def __init__(self, source: str, text: str) -> None:
        """Raises InputError."""
        self.source, self.text = source, text
        with _scene_handle(text, source) as handle:  # the library reports syntax errors
            canonical = _text_of_scene(handle)
        try:
            parsed = groups(canonical)
        except ValueError as error:
            raise input_error(f"{source}: {error}") from None
        self.groups = _placed(text, parsed)
        self._check_groups()

    def study(self) -> Study:
        """The study. Raises InputError."""
        (sweep,) = (group for group in self.groups if group.name == "sweep")
        if not sweep.values.get("base"):
            self._fail(sweep.line, "&sweep: needs base")
        bases = [self._base(sweep, name) for name in sweep.values["base"]]
        axes = [self._axis(number, group) for number, group in enumerate(self._varied(), start=1)]
        is_paired = sweep.values.get("combine") == ["paired"]
        dimensions = self._dimensions(sweep, axes, is_paired)
        try:
            study = Study(bases, dimensions or None)
        except errors.InputError as error:
            self.pass_on(error, several_bases=len(bases) > 1)
        study.input, study.input_file = self.text, self.source
        study.keeps_results = sweep.values.get("states") == ["all"]
        study.file = sweep.values.get("file", [""])[0]
        if len(study) > MOST_CASES:
            self._fail(0, f"&vary: more than {MOST_CASES} cases")
        self._set_reference(study, sweep, is_paired)
        return study

    def pass_on(self, error: errors.MfvError, *, several_bases: bool) -> NoReturn:
        """Raise an error of a study again, with its line in the text."""
        axis, part = error.where or (-1, "")
        axis -= several_bases
        varied = self._varied()
        if not 0 <= axis < len(varied):
            self._complain(self.groups[self._names().index("sweep")], "base", error.message)
        if part == "values":
            group = varied[axis]
            self._fail(group.lines.get("values") or group.lines.get("from") or group.line, f"&vary {axis + 1}: {error.message}")
        self._complain(varied[axis], part, error.message, axis + 1)

    def _names(self) -> list[str]:
        return [group.name for group in self.groups]

    def _varied(self) -> list[_Group]:
        return [group for group in self.groups if group.name == "vary"]

    def _fail(self, line: int, why: str) -> NoReturn:
        raise input_error(f"{self.source}:{line}: {why}" if line else f"{self.source}: {why}")

    def _complain(self, group: _Group, key: str, why: str, number: int = 0) -> NoReturn:
        """Raise an error about a key of a group, or about the group if it does not have the key."""
        name = f"&{group.name} {number}" if number else f"&{group.name}"
        if key in group.values:
            name += f" {key}={', '.join(map(as_written, group.values[key]))}"
        self._fail(group.lines.get(key, group.line), f"{name}: {why}")

    def _check_groups(self) -> None:
        for group in self.groups:
            if group.name in ("body", "scene"):
                self._fail(group.line, f"&{group.name}: a case, not a study; solve it with 'mfv run', or name it as base in &sweep")
            if group.name not in KEYS:
                self._fail(group.line, f"&{group.name}: unknown group{suggestion(group.name, KEYS, '&')}")
            for key in group.lines:
                if key not in KEYS[group.name]:
                    self._fail(group.lines[key], f"&{group.name} {key}: unknown key{suggestion(key, KEYS[group.name])}")
            if group.twice:
                self._fail(group.lines[group.twice[0]], f"&{group.name} {group.twice[0]}: given twice")
            number = self._varied().index(group) + 1 if group.name == "vary" else 0
            for key, values in group.values.items():
                why = _fault_of_values(KEYS[group.name][key], values)
                if why:
                    self._complain(group, key, why, number)
        if self._names().count("sweep") != 1:
            lines = [group.line for group in self.groups if group.name == "sweep"]
            self._fail(lines[-1] if lines else 0, "&sweep: given twice" if lines else "&sweep: group missing")

    def _base(self, sweep: _Group, name: str) -> Base:
        """A base case, which must be valid."""
        path = Path(self.source).parent / name
        try:
            base = Base(text_of_file(path), name, folder=str(path.parent))
            check(base, list(whole_paths(base).items()))
            return base
        except OSError as error:
            self._complain(sweep, "base", f"{name} cannot be read: {error.strerror}")
        except errors.InputError as error:
            self._complain(sweep, "base", error.message)

    def _axis(self, number: int, group: _Group) -> Coordinate:
        """The axis of one &vary."""
        keys = group.values.get("key", [])
        if not keys:
            self._fail(group.line, f"&vary {number}: key missing")
        name = group.values.get("name", keys)[0]
        row = [key for key in ("from", "to", "count") if key in group.values]
        if "values" in group.values:
            if row:
                self._complain(group, row[0], "values is also given; give either values, or from, to and count", number)
            values = group.values["values"]
        elif len(row) == 3:
            values = self._row(number, group, keys)
        else:
            missing = next(key for key in ("from", "to", "count") if key not in group.values)
            self._fail(group.line, f"&vary {number} ({name}): needs values=..., or from, to and count; {missing} is missing")
        try:
            return Coordinate(name, keys, values, group.values.get("factor"))
        except errors.InputError as error:
            assert error.where is not None
            self._complain(group, error.where[1], error.message.removeprefix(f"{name}: "), number)

    def _row(self, number: int, group: _Group, keys: Sequence[str]) -> list[Any]:
        """A sequence of numbers, rounded to distinct whole ones if every key takes whole numbers."""
        first, last, count = (group.values[key][0] for key in ("from", "to", "count"))
        if not 1 <= count <= MOST_VALUES:
            self._complain(group, "count", f"must be a whole number from 1 to {MOST_VALUES}", number)
        is_log = group.values.get("spacing") == ["log"]
        if is_log and not first * last > 0:
            self._complain(group, "spacing", "needs from and to that are nonzero and of the same sign", number)
        parts = [place / max(count - 1, 1) for place in range(count)]
        row = [first * (last / first) ** part if is_log else first + part * (last - first) for part in parts]
        if count > 1:
            row[-1] = last
        about = [key_info(key) for key in keys if key.lower() != DUNDURS_BETA]
        if len(about) == len(keys) and all(one is not None and one[0] for one in about):
            whole = [math.floor(abs(value) + 0.5) * (1 if value >= 0 else -1) for value in row]
            for place, (before, after) in enumerate(zip(whole, whole[1:])):
                if before == after:
                    both = f"{row[place]:g} and {row[place + 1]:g} both become {after}"
                    self._complain(
                        group, "count", f"{both}, since {keys[0]} takes whole numbers; reduce count, or give values=...", number
                    )
            return whole
        return [float(value) for value in row]

    def _dimensions(self, sweep: _Group, axes: Sequence[Coordinate], is_paired: bool) -> list[Dimension]:
        if not is_paired or not axes:
            return [Dimension(axis.name, [axis]) for axis in axes]
        for number, axis in enumerate(axes, start=1):
            if len(axis.values) != len(axes[0].values):
                why = f"&vary {number} has {len(axis.values)} values, &vary 1 has {len(axes[0].values)}"
                self._complain(sweep, "combine", why)
        return [Dimension("row", axes)]

    def _set_reference(self, study: Study, sweep: _Group, is_paired: bool) -> None:
        written = sweep.values.get("reference", ["none"])[0]
        if written == "none":
            return
        if is_paired:
            why = "needs combine='all'; with pairs no other case differs in this key alone"
            self._complain(sweep, "reference", why)
        name, _, value = written.rpartition("=") if "=" in written else ("scene%coupling", "", written)
        axis = next((axis for axis in study.coordinates if name == axis.name or name.lower() in axis.keys[:1]), None)
        values = [] if axis is None else [one for one in axis.values if str(one) == value or _is_number(value, one)]
        try:
            study.set_reference({axis.name if axis else name: values[0] if values else value})
        except errors.InputError:
            why = f"needs a &vary with the single key='{name}' and '{value}' among its values"
            self._complain(sweep, "reference", why)


def _is_number(text: str, number: Any) -> bool:
    """Whether a text is a number, and this one."""
    try:
        return not isinstance(number, (str, bool)) and float(text) == number
    except ValueError:
        return False


def _fault_of_values(key: Key, values: Sequence[Any]) -> str:
    """The error in the values of a key; empty if they are valid."""
    if len(values) > 1 and not key.is_list:
        return "must be one value"
    if any(value is None or isinstance(value, complex) for value in values):
        return "a value is missing between commas"
    if any(isinstance(value, float) and not math.isfinite(value) for value in values):
        return "must be finite"
    if key.kind == "text" and any(isinstance(value, str) and not value.strip() for value in values):
        return "must not be empty"
    words = key.kind.split()
    kinds: dict[str, Any] = {"text": str, "number": (int, float), "whole": int, "any": object}
    is_right = all(
        isinstance(value, kinds[key.kind]) and (key.kind == "any" or not isinstance(value, bool))
        if key.kind in kinds
        else value in words
        for value in values
    )
    return "" if is_right else f"must be {_wanted(key)}"


def _placed(text: str, parsed: Sequence[tuple[str, dict[str, Any]]]) -> list[_Group]:
    """The groups with their values and lines."""
    masked = re.sub(r"'[^'\n]*'|\"[^\"\n]*\"|![^\n]*", lambda found: " " * len(found[0]), text)
    left = list(parsed)
    found = []
    for match in re.finditer(r"&\s*(\w+)([^/&]*)", masked):
        name = match[1].lower()
        group = _Group(name, masked.count("\n", 0, match.start()) + 1)
        for key in re.finditer(r"(\w+)\s*(?:\([^)]*\)\s*)?=", match[2]):
            if key[1].lower() in group.lines:
                group.twice.append(key[1].lower())
            group.lines[key[1].lower()] = masked.count("\n", 0, match.start(2) + key.start()) + 1
        place = next((place for place, one in enumerate(left) if one[0] == name), None)
        values = left.pop(place)[1] if place is not None else {}
        group.values = {key: value if isinstance(value, list) else [value] for key, value in values.items()}
        found.append(group)
    return found
