"""Measured columns in text files, as instruments, spreadsheets and programs write them, with their units.

What a text may look like is the same here and in the library (src/io/input/table_file.f90; docs/guide.md): UTF-8, with or without a
byte-order mark, or UTF-16; lines that end with LF, CR LF, CR CR LF or CR; between cells a semicolon, a comma, tabs or blanks; decimal
commas where they cannot be separators; cells in quotation marks; comments (#, !, %, //); lines of text before the numbers.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._suggestions import some
from .errors import MfvError, input_error

Array = NDArray[np.float64]

#: Metres per unit of length.
LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "in": 0.0254, "mil": 2.54e-5}
#: Newtons per unit of force.
FORCES = {"N": 1.0, "kN": 1e3, "MN": 1e6, "daN": 10.0, "mN": 1e-3, "uN": 1e-6, "lbf": 4.4482216152605, "kgf": 9.80665}
_OTHER_NAMES = {"micron": "um", "microns": "um", "inch": "in", "mils": "mil"} | {
    f"{prefix}met{end}{plural}": unit
    for prefix, unit in (("", "m"), ("centi", "cm"), ("milli", "mm"), ("micro", "um"), ("nano", "nm"))
    for end in ("er", "re")
    for plural in ("", "s")
}

_BRACKET = re.compile(r"[\[({]\s*([^\[\](){}]+?)\s*[\])}]\s*$")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?", re.ASCII)
#: A number at the beginning, or before a unit at the end.
_VALUE = re.compile(r"^[+-]?\.?\d|\s[+-]?[.,]?\d[\d.,]*\s*[A-Za-zµμ]+$", re.ASCII)
_WHOLE = re.compile(r"\s*[0-9]+\s*")
_NO_VALUES = ("", "nan", "na", "n/a", "null", "bad", "-", "--", "---", "*", "***")
_QUOTED = r"\"(?:[^\"]|\"\")*\"|'[^']*'"
#: A time of the day or a duration, perhaps after a date: 12:03:04.5, 3:04.5, 2026-01-02T12:03:04Z, 02.01.2026 12:03:04, 1:03:04 PM.
_CLOCK = re.compile(r"(?:(\S+?)(?:T|\s+))?(?:(\d+):)?(\d+):(\d+(?:[.,]\d*)?)(?:\s*([AP])M)?\s*(?:Z|[+-]\d\d:?\d\d)?", re.A | re.I)
_DATES = ("%Y-%m-%d", "%Y/%m/%d", "%d.%m.%Y")
_DAY = 86400.0
#: Names of a column of heights, in lower case.
_HEIGHTS = ("z", "h", "height", "heights", "depth", "profile", "recess")
#: Lines among which columns and decimal marks are recognised.
_SAMPLE = 1000
#: Bytes by which a file is recognised as a text.
_START = 2**20


# --- units ---


def unit_of(text: str) -> str:
    """The unit that a heading ends with, such as 'mm' in 'x [mm]', 'x (mm)', 'x in mm', 'x / mm', 'x/mm', 'Lateral mm'; empty for none."""
    bracket = _BRACKET.search(text)
    words = [bracket[1]] if bracket else text.split()[-1:]
    unit = known_unit(words[0]) if words else ""
    if not unit and words == text.split():
        unit = known_unit(words[0].partition("/")[2])
    return unit


def written_unit(text: str) -> str:
    """The unit that a heading ends with, or what it has in brackets instead, which is not a known unit; empty for none."""
    bracket = _BRACKET.search(text)
    return unit_of(text) or (bracket[1].strip("-\u2013 ") if bracket else "")


def known_unit(word: str) -> str:
    """A unit as it is written here; empty for another word."""
    unit = word.replace("µ", "u").replace("μ", "u")
    unit = _OTHER_NAMES.get(unit.lower(), unit)
    force, per, length = unit.partition("/")
    return unit if unit in LENGTHS or (force in FORCES and (length in LENGTHS or not per)) else ""


def name_of(text: str) -> str:
    """A heading without its unit, in lower case."""
    bare = re.sub(r"/?\s*[\[({][^\[\](){}]*[\])}]\s*$", "", text).strip()
    if bare == text.strip() and unit_of(text):
        *words, last = bare.split()
        if not known_unit(last):
            bare = " ".join([*words, last.partition("/")[0]])
        elif words:
            bare = re.sub(r"(\s+in|\s*/|\s*,)?\s+\S+$", "", bare)
    return bare.strip().lower()


def factor(unit: str, to: str, label: str = "") -> float:
    """Units `to` per `unit`, of the column with a label. Raises InputError for an unknown unit, and for units of different quantities."""
    here, there = _size(unit, label), _size(to)
    if here[1] != there[1]:
        raise input_error(f"{_of(label)}a value in {unit} is a {here[1]} and cannot be in {to}, which is for a {there[1]}")
    return here[0] / there[0]


def _size(unit: str, label: str = "") -> tuple[float, str]:
    """A unit in SI units, and its quantity. Raises InputError."""
    known = known_unit(unit) or unit
    force, per, length = known.partition("/")
    if known in LENGTHS:
        return LENGTHS[known], "length"
    if known in FORCES:
        return FORCES[known], "force"
    if per and force in FORCES and length in LENGTHS:
        return FORCES[force] / LENGTHS[length], "force per length"
    raise input_error(
        f"{_of(label)}unknown unit '{unit}'; known are {', '.join(LENGTHS)}; {', '.join(FORCES)}; and forces per length, such as N/mm"
    )


def _of(label: str) -> str:
    """The beginning of a message about a column, if there is one."""
    return f"{label}: " if label else ""


def is_force(unit: str, label: str = "") -> bool:
    """Whether a unit, of the column with a label, is one of force, not of force per length. Raises InputError."""
    return _size(unit, label)[1] == "force"


# --- lines ---


def check_text(path: str | os.PathLike[str]) -> None:
    """Raises InputError with line and column if a file does not begin like a text in one of the known encodings; OSError."""
    with open(path, "rb") as file:
        _lines_of(file.read(_START), os.fspath(path))


def is_text(path: str | os.PathLike[str]) -> bool:
    """Whether a file begins like a text in one of the known encodings. Raises OSError."""
    try:
        check_text(path)
    except MfvError:
        return False
    return True


def _lines(path: str | os.PathLike[str]) -> list[str]:
    """The lines of a text file. Raises OSError; InputError with line and column for a file that is not a text."""
    with open(path, "rb") as file:
        return _lines_of(file.read(), os.fspath(path))


def _lines_of(data: bytes, name: str) -> list[str]:
    """The lines of a text. Raises InputError."""
    zeros, pairs = [byte == 0 for byte in data[:4]], data[: len(data) // 2 * 2]
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = pairs.decode("utf-16", "replace")
    elif zeros in ([False, True, False, True], [True, False, True, False]):
        text = pairs.decode("utf-16-le" if zeros[1] else "utf-16-be", "replace")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.replace(b"\xe2\x88\x92", b"-").replace(b"\xc2\xa0", b" ").decode("latin-1")
    text = re.sub("\r*\n|\r+", "\n", text[:-1] if text.endswith("\x1a") else text)
    text = text.replace("\u2212", "-").replace("\u00a0", " ").replace("\f", " ")
    control = re.search(r"[\x00-\x08\x0b-\x1f\x7f]", text)
    if control:
        line, column = text.count("\n", 0, control.start()) + 1, control.start() - text.rfind("\n", 0, control.start())
        raise input_error(f"{name}:{line}:{column}: not a text file: control character {ord(control[0])}")
    return text.split("\n")


def _shown(line: str) -> str:
    """A line for a message."""
    line = line.strip().replace("\t", " ")
    return line if len(line) <= 80 else line[:77] + "..."


def _without_comment(line: str) -> str:
    """A line without a comment at its end; in double quotation marks # is a sign like others."""
    return line if "#" not in line else re.match(r'(?:"[^"]*"|[^#])*', line)[0]  # type: ignore[index]  # it matches anything


def _is_comment(line: str) -> bool:
    """Whether a line is blank, has only separators, or is a comment."""
    return not line.strip(" \t,;") or line.lstrip().startswith(("#", "!", "%", "//"))


def _is_heading(line: str) -> bool:
    """Whether a line before the numbers is text: it has a letter, and its first word does not begin like a number."""
    first = (re.split(r"[\s,;\"']", line.strip(" \t\"'"), maxsplit=1) or [""])[0].lower()
    return bool(re.search("[A-Za-z]", line)) and first[:1] not in tuple("0123456789+-.") and first not in ("nan", "inf", "infinity")


def _divided(line: str, decimal_comma: bool, marks: str = ";,") -> tuple[list[str], int]:
    """The cells of a line, quotation marks included, and the number of separators at its end. Between them is the first of `marks` that
    the line has, or blanks; a comma only if it cannot be a decimal mark."""
    bare = line.rstrip(" \t,;")
    spare = len(re.findall("[,;\t]", line[len(bare) :]))
    outside = re.sub(rf"(?:^|(?<=[\s,;]))({_QUOTED})", "", bare)
    is_list = not decimal_comma or _is_heading(line) or re.search("[\"']", line)
    mark = next((mark for mark in marks if mark in outside and (mark != "," or is_list)), "")
    if not mark:
        return re.findall(rf"{_QUOTED}|\S+", bare), spare
    return [cell.strip() for cell in re.findall(rf"([ ]*(?:{_QUOTED})?[^{mark}]*){mark}", bare + mark)], spare


def _headings(line: str) -> list[str]:
    """The cells of a heading without quotation marks; a unit in brackets belongs to the word before it."""
    text = line.lstrip(" \t#!%/") if _is_comment(line) else _without_comment(line)
    if not re.search("[;,\t]", text):
        cells = re.findall(rf"(?:{_QUOTED}|[^\s\[(]\S*)(?:\s+[\[(][^\])]*[\])])?|\S+", text)
    else:
        cells = _divided(text, True, ";\t,")[0]
    return [cell.strip("\"' \t") for cell in cells]


def _value(cell: str, decimal_comma: bool) -> float | None:
    """A number, NaN for a cell without a value, None for anything else. In quotation marks a comma is a decimal mark."""
    bare = cell
    if len(cell) > 1 and cell[0] in "\"'" and cell[-1] == cell[0]:
        bare = cell[1:-1].strip()
    if "," in bare and "." not in bare and (decimal_comma or bare != cell):
        bare = bare.replace(",", ".", 1)
    elif decimal_comma and "." in bare:
        return None
    if _NUMBER.fullmatch(bare):
        value = float(bare.lower().replace("d", "e"))
        return value if math.isfinite(value) else None
    return math.nan if bare.lower() in _NO_VALUES else None


def _cells(line: str, columns: int, decimal_comma: bool) -> list[str] | None:
    """The cells of a row with that many; None for a line with fewer or more. Separators at its end stand for cells without a value."""
    text = _without_comment(line)
    fit = None
    for marks, needs in ((";,", ""), (";\t,", "\t"), (",", ";,")):  # a text between commas may have a semicolon
        if all(mark in text for mark in needs):
            cells, spare = _divided(text, decimal_comma, marks)
            if len(cells) == columns:
                return cells
            if len(cells) < columns <= len(cells) + spare:
                fit = cells + [""] * (columns - len(cells))
    return fit


def _row(line: str, columns: int, decimal_comma: bool) -> list[float] | None:
    """The numbers of a row, NaN without a value; None for a line that is not one."""
    cells = _cells(line, columns, decimal_comma)
    if cells is None:
        return None
    values = [_value(cell, decimal_comma) for cell in cells]
    if not cells or None in values:
        return None
    if columns > 1 and all(value != value for value in values) and "nan" not in line.lower():
        return None  # dashes alone may be a line of units
    return values  # type: ignore[return-value]


# --- traces: positions and heights ---


class Trace(NamedTuple):
    """Heights, with NaN where there is no value, at increasing positions or, if these are None, at equal distances; units or ''; whether
    the heading says that heights are the recess."""

    x: Array | None
    height: Array
    x_unit: str
    height_unit: str
    is_recess: bool


class Ambiguous(MfvError):
    """A text whose rows have two readings."""


class Unordered(MfvError):
    """A text with positions that turn or do not change."""


def read_trace(path: str | os.PathLike[str], heights_alone: bool = False) -> Trace:
    """The columns x and height, or heights alone, of a text file; a first column of row numbers is dropped.

    Rows such as 0,5 are x and height, or heights with a decimal comma, by what the line above them names, x,z or z; without names they
    are heights if these are `heights_alone` or if x would turn. Raises OSError, InputError with line and what would be right; Unordered
    for positions that turn; Ambiguous for such rows that may be both.
    """
    name, lines = os.fspath(path), _lines(path)
    sample = [line for line in lines[:_SAMPLE] if not _is_comment(line)]
    choices = [(columns, comma) for columns in (2, 3, 1) for comma in (False, True)]
    columns, comma = max(choices, key=lambda choice: _longest(_row(line, *choice) is not None for line in sample))
    rows, numbers, start = _block(name, lines, columns, comma)
    table = np.array(rows, dtype=float).reshape(-1, columns)
    if columns == 3:
        if not _is_numbering(table):
            raise _no_row(name, numbers[0], lines)
        table = table[:, 1:]
    if columns == 1 and _is_count(lines, numbers, table):
        table = table[1:]
    fault = _disorder(table[:, 0]) if columns > 1 else None
    alone = [_row(lines[number - 1], 1, True) for number in numbers] if columns == 2 and not comma else []
    if alone and None not in alone:
        named = _named(lines[: start - 1])
        if named == 1 or (not named and (heights_alone or fault is not None)):
            table, fault = np.array(alone), None
        elif not named:
            raise Ambiguous(
                None,
                f"{name}:{numbers[0]}: '{_shown(lines[numbers[0] - 1])}' may be x and height, or one height with a decimal comma; "
                "name the columns in the line above, x,z or z, or separate x and height by a semicolon",
            )
    if fault is not None:
        raise Unordered(
            None, f"{name}:{numbers[fault]}: x must increase from line to line, or decrease; sort the rows, one for each x"
        )
    units = _units_of_trace(lines[: start - 1], columns)
    if table.shape[1] == 1:
        return Trace(None, table[:, 0], "", units[-1], _names_recess(lines[: start - 1]))
    x = table[:, 0][np.isfinite(table[:, 0])]
    if x.size > 1 and x[0] > x[-1]:
        table = table[::-1]
    return Trace(table[:, 0].copy(), table[:, 1].copy(), units[0], units[1], _names_recess(lines[: start - 1]))


def _names_recess(head: Sequence[str]) -> bool:
    """Whether the lines before the numbers say that heights are the recess, as those of `mfv profile` do."""
    return any(re.search(r"\b(recess|recedes)\b", line, re.IGNORECASE) for line in head)


def _named(head: Sequence[str]) -> int:
    """The number of columns that the last line of text before the numbers names: 2 for two names with a comma between them, or with two
    units; 1 for a height, or a unit; 0 if it says neither."""
    texts = [line.lstrip(" \t#!%/") if _is_comment(line) else line for line in head]
    above = next((text for text in reversed(texts) if _is_heading(text)), "")
    cells = _headings(above)
    if len(cells) == 2 and known_unit(cells[1]) and not known_unit(cells[0]):
        cells = [f"{cells[0]} [{cells[1]}]"]  # height, mm
    if len(cells) == 1:
        return int(name_of(cells[0]) in _HEIGHTS or bool(unit_of(cells[0])))
    is_pair = len(cells) == 2 and ("," in above or all(map(unit_of, cells)))
    return 2 if is_pair and not any(_VALUE.search(cell) for cell in cells) else 0


def _units_of_trace(head: Sequence[str], columns: int) -> list[str]:
    """The units of positions and heights in the lines before the numbers, or '': of the last heading with a unit for every column, or
    with one unit; else of a comment. Lines with numbers, such as a cutoff, are no headings."""
    is_comment = [_is_comment(line) for line in head]
    for kind in (False, True):
        texts = [line.lstrip(" \t#!%/") for line, comment in zip(head, is_comment) if comment == kind]
        for cells in map(_headings, reversed([text for text in texts if _is_heading(text)])):
            units = [unit_of(cell) for cell in cells]
            if len(cells) != columns:
                units = [unit for cell, unit in zip(cells, units) if unit and cell != "in"]
            if any(units) and len(units) in (1, columns) and not any(_VALUE.search(cell) for cell in cells):
                return ["", *units][-2:]
    return ["", ""]


def _longest(are_rows: Iterable[bool]) -> int:
    """The longest run of true values."""
    best = run = 0
    for is_row in are_rows:
        run = run + 1 if is_row else 0
        best = max(best, run)
    return best


def _no_row(name: str, number: int, lines: Sequence[str]) -> Exception:
    return input_error(f"{name}:{number}: must be two numbers, x and height, not '{_shown(lines[number - 1])}'")


def _block(name: str, lines: Sequence[str], columns: int, comma: bool) -> tuple[list[list[float]], list[int], int]:
    """The rows of numbers, their lines, and the first of these. Raises InputError for what is neither a row nor text before them."""
    used = [number for number, line in enumerate(lines, start=1) if not _is_comment(line)]
    start = next((number for number in used if _row(lines[number - 1], columns, comma)), 0)
    head = [number for number in used if number < start or not start]
    last_heading = max((number for number in head if _is_heading(lines[number - 1])), default=0)
    rest = [number for number in head if number > last_heading or not start]
    counted = rest[0] if len(rest) == 1 and start and _WHOLE.fullmatch(lines[rest[0] - 1]) else 0
    if rest and not counted:
        raise _no_row(name, rest[0], lines)
    rows, numbers = [], [number for number in used if number >= start > 0]
    for number in numbers:
        row = _row(lines[number - 1], columns, comma)
        if row is None:
            raise _no_row(name, number, lines)
        rows.append(row)
    if counted and abs(int(lines[counted - 1]) - len(rows)) > 1:
        raise input_error(f"{name}:{counted}: the file has {len(rows)} rows, not {lines[counted - 1].strip()}")
    return rows, numbers, start or len(lines) + 1


def _is_numbering(table: Array) -> bool:
    """Whether the first column numbers the rows from 0 or 1 and the second increases or decreases."""
    first, steps = table[:, 0], np.diff(table[:, 1])
    return bool(
        first[0] in (0.0, 1.0) and np.all(np.diff(first) == 1.0) and len(steps) > 0 and (np.all(steps > 0.0) or np.all(steps < 0.0))
    )


def _is_count(lines: Sequence[str], numbers: Sequence[int], table: Array) -> bool:
    """Whether the first of the heights is their number."""
    are_whole = [bool(_WHOLE.fullmatch(lines[number - 1])) for number in numbers[:2]]
    return are_whole == [True, False] and bool(abs(table[0, 0] - len(table) + 1) < 1.5)


def _disorder(x: Array) -> int | None:
    """The first row in which positions turn or do not change; None for none."""
    given = np.flatnonzero(np.isfinite(x))
    steps = np.diff(x[given])
    if not len(steps):
        return None
    wrong = np.flatnonzero(steps * np.sign(steps[0]) <= 0.0)
    return int(given[wrong[0] + 1]) if len(wrong) else None


# --- columns with names ---


@dataclass
class Column:
    """A measured column: its table or file, its name there, its unit as it is written or '', and its values (numbers, or texts of a
    file)."""

    table: str
    name: str
    unit: str
    values: Any
    decimal_comma: bool = False

    @property
    def label(self) -> str:
        """What it is called in messages."""
        return f"{self.table}: column {self.name}"

    def numbers(self) -> Array:
        """The values as numbers; NaN for cells without one. Raises InputError."""
        found = []
        for value in np.atleast_1d(np.asarray(self.values)).tolist():
            number = _value(value, self.decimal_comma) if isinstance(value, str) else math.nan if value is None else value
            try:
                found.append(float(number))  # type: ignore[arg-type]  # TypeError for anything else
            except (TypeError, ValueError):
                raise input_error(f"{self.label}: {value!r} is not a number") from None
        return np.array(found)

    def seconds(self) -> Array | None:
        """Times of the day, durations or dates with times as seconds from the first; None if a value is something else.

        A time of the day that is earlier than the one before by more than half a day is one of the next day.
        """
        values = np.atleast_1d(np.asarray(self.values))
        if values.dtype.kind in "mM":
            return np.asarray((values - values[0]) / np.timedelta64(1, "s"))
        found = [_CLOCK.fullmatch(str(value).strip("\"' ")) for value in values.tolist()]
        if None in found:
            return None
        dates, seconds = [match[1] or "" for match in found], np.array([_seconds(match) for match in found])  # type: ignore[index,arg-type]
        if len(set(dates)) > 1:
            days = {date: _day(date) for date in set(dates)}
            if None in days.values():
                return None
            seconds = seconds + _DAY * np.array([days[date] for date in dates], dtype=float)
        elif not dates[0]:
            seconds[1:] += _DAY * np.cumsum(np.diff(seconds) < -0.5 * _DAY)
        return np.asarray(seconds - seconds[0])


def _seconds(clock: re.Match[str]) -> float:
    """The seconds of a time of the day; minutes and seconds, or hours and minutes, if it has two numbers."""
    _, hours, minutes, seconds, half = clock.groups()
    if half:
        hours, minutes, seconds = (hours, minutes, seconds) if hours else (minutes, seconds, "0")
        hours = int(hours) % 12 + (12 if half in "pP" else 0)
    return 3600.0 * int(hours or 0) + 60.0 * int(minutes) + float(seconds.replace(",", "."))


def _day(date: str) -> int | None:
    """The number of a day; None for a date whose order is not known, such as 1/2/2026."""
    for form in _DATES:
        try:
            return datetime.strptime(date, form).toordinal()
        except ValueError:
            continue
    return None


@dataclass
class Rows:
    """A table in a text file: line and names of its heading, lines of its rows, places from 0 of the columns of texts, and whether
    commas are decimal marks."""

    file: str
    text: list[str]
    header: int
    names: list[str]
    lines: list[int]
    texts: list[int]
    decimal_comma: bool

    def cells(self, line: int) -> list[str]:
        """The cells of a row. Raises InputError for another number of them than of names."""
        cells = _cells_of(self.file, line, self.text, len(self.names), self.decimal_comma)
        return [_without_quotes(cell) if place in self.texts else cell for place, cell in enumerate(cells)]

    def number(self, cell: str) -> float:
        """The number in a cell; NaN for anything else."""
        value = _value(cell, self.decimal_comma)
        return math.nan if value is None else value


#: Names of a column, or its number from 1.
Names = Mapping[str, "Sequence[str] | int"]


def read_columns(path: str | os.PathLike[str], wanted: Names, optional: Sequence[str] = ()) -> dict[str, Column]:
    """The columns `wanted` of a text file, by their names in lower case in a heading, which may have units or be followed by a line of
    units, or by their numbers. Those that are `optional` may be missing; others of the file may have anything.

    Raises OSError, InputError.
    """
    name, lines = os.fspath(path), _lines(path)
    header, names = _header(name, lines, wanted, optional)
    places = _chosen(name, names, wanted, optional)
    needed = [place for meaning, place in places.items() if meaning not in optional]
    below, comma = _below(lines, header, len(names), needed)
    units = [written_unit(heading) for heading in names]
    if below and header and _numbers_in(lines[below[0] - 1], len(names), needed, comma) < len(needed):  # a line of units
        written = _headings(lines[below[0] - 1])
        cells_of_units = [written[place] for place in needed] if len(written) == len(names) else ["?"]
        if all(not cell or unit_of(cell) or cell[0] in "[(-" for cell in cells_of_units):
            units = [written_unit(cell) or unit for cell, unit in zip(written, units)]
            del below[0]
    if not header:  # columns by number
        while below and _numbers_in(lines[below[0] - 1], len(names), needed, comma) < len(needed):
            del below[0]
    if not below:
        raise input_error(f"{name}: no rows; needs a line with the names of the columns, such as Q,U,P, and rows of numbers")
    rows = [_cells_of(name, number, lines, len(names), comma) for number in below]
    for row, number in zip(rows, below):
        for meaning in places.keys() - optional:
            cell = row[places[meaning]]
            if _value(cell, comma) is None:
                column = lines[number - 1].find(cell) + 1
                raise input_error(f"{name}:{number}:{column}: column {names[places[meaning]]}: '{_shown(cell)}' is not a number")
    return {
        meaning: Column(name, names[place] or str(place + 1), units[place], [row[place] for row in rows], comma)
        for meaning, place in places.items()
    }


def read_rows(path: str | os.PathLike[str], are_texts: Container[str]) -> Rows:
    """The rows of a text file under a line with the names of the columns. `are_texts`: names, without a unit in brackets, of columns that
    are not numbers; those in double quotation marks may extend over lines. Raises OSError, InputError."""
    name, lines = os.fspath(path), _joined(_lines(path))
    header = next((number for number, line in enumerate(lines, start=1) if not _is_comment(line)), 0)
    names = _headings(lines[header - 1]) if header else []
    texts = [place for place, heading in enumerate(names) if _BRACKET.sub("", heading).strip() in are_texts]
    numbers = [place for place in range(len(names)) if place not in texts]
    below, comma = _below(lines, header, len(names), numbers) if header else ([], False)
    return Rows(name, lines, header, names, below, texts, comma)


def _joined(lines: list[str]) -> list[str]:
    """Lines, with a cell in double quotation marks that extends over several in the first of them; the others are empty."""
    ends = [place for place, line in enumerate(lines) if line.count('"') % 2 and not _is_comment(line)]
    for first, last in zip(ends[::2], ends[1::2]):
        lines[first : last + 1] = [" ".join(lines[first : last + 1]), *[""] * (last - first)]
    return lines


def _below(lines: Sequence[str], header: int, columns: int, places: Sequence[int]) -> tuple[list[int], bool]:
    """The numbers of the lines below a header that are not comments, and whether more of their cells are numbers with decimal commas than
    with points. `places`: of the cells that must be numbers, from 0."""
    below = [number for number in range(header + 1, len(lines) + 1) if not _is_comment(lines[number - 1])]
    point, comma = (
        sum(_numbers_in(lines[number - 1], columns, places, mark) for number in below[:_SAMPLE]) for mark in (False, True)
    )
    return below, comma > point


def _numbers_in(line: str, columns: int, places: Sequence[int], comma: bool) -> int:
    """How many of the cells at certain places from 0 are numbers or without a value; 0 for a line that is not a row."""
    cells = _cells(line, columns, comma)
    return 0 if cells is None else sum(_value(cells[place], comma) is not None for place in places)


def _cells_of(name: str, number: int, lines: Sequence[str], columns: int, comma: bool) -> list[str]:
    """The cells of a row without quotation marks, except for numbers with decimal commas in them. Raises InputError for another number
    of them."""
    line = lines[number - 1]
    cells = _cells(line, columns, comma)
    if cells is not None:
        return [cell if "," in cell else _without_quotes(cell) for cell in cells]
    found = max(len(_divided(_without_comment(line), comma, marks)[0]) for marks in (";,", ";\t,", ","))
    advice = ""
    if found > columns:
        advice = "; decimal commas need semicolons or tabs between cells, texts with commas or semicolons need quotation marks"
    raise input_error(
        f"{name}:{number}: must have {columns} cells, as many as the names of the columns, not the {found} of '{_shown(line)}'{advice}"
    )


def _without_quotes(cell: str) -> str:
    """A cell without quotation marks around it."""
    is_quoted = len(cell) > 1 and cell[0] == cell[-1] and cell[0] in "\"'"
    return cell[1:-1].replace('""', '"').strip() if is_quoted else cell


def _places(names: Sequence[str], keys: Sequence[str] | int) -> list[int]:
    """The places from 0 of the columns with the first of the names in lower case that there is, or with a number from 1."""
    if isinstance(keys, int):
        return [keys - 1] if 1 <= keys <= len(names) else []
    bare, written = [name_of(name) for name in names], [name.strip().lower() for name in names]
    return next(
        ([place for place, each in enumerate(found) if each == key] for key in keys for found in (bare, written) if key in found),
        [],
    )


def _chosen(label: str, names: Sequence[str], wanted: Names, optional: Sequence[str]) -> dict[str, int]:
    """The places from 0 of the wanted columns that there are. Raises InputError for a needed one whose name another has too."""
    result = {}
    for meaning, keys in wanted.items():
        places = _places(names, keys)
        if len(places) > 1 and meaning not in optional:
            numbers = ", ".join(str(place + 1) for place in places)
            raise input_error(
                f"{label}: columns {numbers} have the same name, {names[places[0]]}; choose one by its number, such as "
                f"columns={{'{meaning}': {places[0] + 1}}}, or rename the others"
            )
        if places:
            result[meaning] = places[0]
    return result


def _header(name: str, lines: Sequence[str], wanted: Names, optional: Sequence[str]) -> tuple[int, list[str]]:
    """The number of the line with the names of the columns, and these; 0 and empty names for columns by number. Raises InputError."""
    needed = {meaning: keys for meaning, keys in wanted.items() if meaning not in optional}
    best: tuple[int, list[str]] = (0, [])
    fewest = len(needed) + 1
    for number, line in enumerate(lines[:_SAMPLE], start=1):
        names = _headings(line)
        missing = sum(not _places(names, keys) for keys in needed.values())
        if any(isinstance(keys, int) for keys in needed.values()) and not _is_heading(line):
            continue
        if names and missing < fewest and (not _is_comment(line) or missing == 0):
            best, fewest = (number, names), missing
        if missing == 0:
            return best
    if all(isinstance(keys, int) for keys in needed.values()):
        counts = [len(cells) for line in lines[:_SAMPLE] if not _is_comment(line) and (cells := _divided(line, False)[0])]
        return 0, [""] * max(counts, default=0)
    used = [line for line in lines if not _is_comment(line)]
    if len(used) < 2:
        raise input_error(f"{name}: no rows; needs a line with the names of the columns, such as Q,U,P, and rows of numbers")
    raise missing_columns(name, needed, best[1])


def missing_columns(label: str, wanted: Names, names: Sequence[str]) -> Exception:
    """The InputError about wanted columns that are not among names."""
    missing = [str(keys) if isinstance(keys, int) else keys[-1] for keys in wanted.values() if not _places(names, keys)]
    short = [word.upper() if len(word) == 1 else word for word in missing]
    there = some([_shown(name) for name in names]) or "none"
    return input_error(f"{label}: no column {', '.join(short)}; there are {there}")


def columns_of(table: Any, label: str, wanted: Names, optional: Sequence[str] = ()) -> dict[str, Column]:
    """The columns `wanted` of a mapping or a pandas.DataFrame, as `read_columns` finds them. Raises InputError."""
    keys = list(table.columns if hasattr(table, "columns") else table)
    names = [str(key) for key in keys]
    needed = {meaning: known for meaning, known in wanted.items() if meaning not in optional}
    if any(not _places(names, known) for known in needed.values()):
        raise missing_columns(label, needed, names)
    places = _chosen(label, names, wanted, optional)
    return {
        meaning: Column(label, names[place], written_unit(names[place]), table[keys[place]]) for meaning, place in places.items()
    }
