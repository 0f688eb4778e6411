"""Bad input: every key of every group, wrong in every way that can be made of the table in key_table.py, is refused with a message
that names file, line, group, key, value and what is right; what is right is taken."""

from __future__ import annotations

import math
import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
from key_table import CASE, SCENES, Groups, Row

from mfv import Case
from mfv.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
RUN = os.environ.get("MFV_RUN", str(ROOT / "build/release/bin/mfv_run"))
INPUT_ERROR = 2
ROWS = [(*key, row) for key, row in CASE.items()]

#: Written values that are not numbers.
NO_NUMBERS = [
    "x",
    "'1'",
    ".true.",
    "''",
    "",
    "NaN",
    "nan",
    "Inf",
    "-Inf",
    "Infinity",
    "1e400",
    "-1e400",
    "1.7976931348623159e308",
    "1.5+3",
    "1e",
    "1e5e5",
    "1..2",
    "--1",
    "0x10",
    ".",
    "-",
    "½",
    "1;2",
]
NO_WHOLES = ["1.5", "1e3", "2147483648", "99999999999999999999", "-99999999999999999999", "5d0"]
NO_TEXTS = ["bare", "1", ".true.", "", "1, 'a'"]
NO_LOGICALS = ["1", "'true'", "yes", "", ".tru.", "''", "1.0"]

#: Numbers at the ends of what is taken; and beyond, where products would overflow or vanish.
EXTREMES = ["1e100", "-1e100", "1e-100", "-1e-100", "1e-400", "-0.0", "0"]
BEYOND = ["1.0000001e100", "-1e101", "1e300", "-1e300", "1.7976931348623157e308", "0.9999999e-100", "-1e-101", "1e-300", "4.9e-324"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with the files that the scenes name; the process works in it."""
    folder = tmp_path_factory.mktemp("bad_input")
    (folder / "profile.txt").write_text("-1 1\n0 0\n1 1\n")
    (folder / "mu.txt").write_text("-1 0.7\n1 0.7\n")
    (folder / "loads.csv").write_text("time,tangential_force\n0,1e-4\n1,-1e-4\n")
    before = Path.cwd()
    os.chdir(folder)
    yield folder
    os.chdir(before)


def written(groups: Groups, row: Row | None = None, key: str = "", entry: str | None = None) -> str:
    """A text with one group a line; `entry` in place of the key of the row, in a line of its own; None: the key is omitted."""
    lines: list[str] = []
    seen: dict[str, int] = {}
    for group, keys in groups:
        seen[group] = seen.get(group, 0) + 1
        if row is not None and (group, seen[group]) == (row.group, row.number):
            others = [f"{name}={value}" for name, value in keys.items() if name != key and name not in row.without]
            lines += [f"&{group} {', '.join(others)}", *([entry] if entry is not None else []), "/"]
        else:
            lines.append(f"&{group} {', '.join(f'{name}={value}' for name, value in keys.items())} /")
    return "\n".join(lines) + "\n"


def line_of_group(groups: Groups, row: Row) -> int:
    """Line of the row's group; its key is in the next one."""
    found = [i for i, (group, _) in enumerate(groups, 1) if group == row.group]
    return found[row.number - 1]


def complaint(text: str) -> str:
    """What the library says of a case; empty: it takes it."""
    try:
        with Case.from_text(text, "case.nml"):
            return ""
    except InputError as error:
        return str(error)


def wrong_values(row: Row) -> Iterator[str]:
    """Values of the wrong kind or out of the range."""
    if row.kind in ("real", "whole"):
        yield from NO_NUMBERS + (NO_WHOLES if row.kind == "whole" else [])
    if row.kind == "real":
        yield from (value for value in EXTREMES if not in_range(row, float(value)))
        yield from BEYOND
        if row.lower > -math.inf:
            yield repr(row.lower) if row.above else repr(math.nextafter(row.lower, -math.inf))
        if row.upper < math.inf:
            yield repr(math.nextafter(row.upper, math.inf))
    if row.kind == "whole":
        yield from (str(int(row.lower) - 1), str(int(row.upper) + 1), "-2147483648")
    if row.kind == "text":
        yield from NO_TEXTS
    if row.kind == "logical":
        yield from NO_LOGICALS
    if row.kind == "choice":
        yield from (*NO_TEXTS, "''", f"'{row.choices[0]}x'", f"'{' '.join(row.choices)}'", row.choices[0])


def right_values(row: Row) -> Iterator[str]:
    """Values of the right kind in the range: at its ends, extreme ones, every choice."""
    yield row.value
    if row.kind == "real":
        yield from (value for value in EXTREMES if in_range(row, float(value)))
        if row.lower > -math.inf:
            yield repr(row.lower + 1e-15) if row.above else repr(row.lower)
        if row.upper < math.inf:
            yield repr(row.upper)
    if row.kind == "whole":
        yield from (str(int(row.lower)), str(int(row.upper)), f"+{row.value}", f"000{row.value}")
    if row.kind == "text":
        yield "''"
    if row.kind == "logical":
        yield from (".true.", ".false.", "T", "f", ".TRUE.")
    if row.kind == "choice":
        yield from (f"'{choice}'" for choice in row.choices)


def in_range(row: Row, value: float) -> bool:
    return (value > row.lower if row.above else value >= row.lower) and value <= row.upper


def shown(value: str) -> str:
    """A written value as a message shows it."""
    values = re.findall(r"'[^']*'|[^\s,]+", value)
    if match := re.fullmatch(r"(\d+)\*(.*)", value):
        values = [match[2]] * int(match[1])
    return ", ".join(values)


def test_every_key_has_a_row_and_every_row_a_key() -> None:
    printed = subprocess.run([RUN, "--keys"], capture_output=True, text=True, check=True).stdout
    keys: dict[tuple[str, str], tuple[str, str]] = {}
    group = ""
    for line in printed.splitlines():
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif line.startswith("| `"):
            name, takes, _, unit, _ = (cell.strip() for cell in line.strip("|").split(" | ", 4))
            keys[group, name.strip("`")] = takes, unit
    assert keys.keys() == CASE.keys(), keys.keys() ^ CASE.keys()
    assert keys == {key: (row.right + ", or a list" * row.is_list, row.unit) for key, row in CASE.items()}


@pytest.mark.parametrize(("group", "key", "row"), ROWS, ids=[f"{group}-{key}" for group, key, _ in ROWS])
def test_every_fault_of_a_key_is_told(folder: Path, group: str, key: str, row: Row) -> None:
    groups = SCENES[row.scene]
    line = line_of_group(groups, row)

    def refused(entry: str | None, expected: str, at: int = line + 1) -> None:
        message = complaint(written(groups, row, key, entry))
        assert re.match(rf"case\.nml:{at}: &{group}\b", message), (entry, message)
        assert expected in message and "\n" not in message and len(message) < 1000, (entry, message)

    for value in wrong_values(row):
        unit = f" ({row.unit})" if row.unit else ""
        refused(f"{key}={value}", f"&{group} {key}={shown(value)}: must be {row.right}{unit}")
    if not row.is_list:
        for value in (f"{row.value}, {row.value}", f"{row.value} {row.value}", f"2*{row.value}"):
            refused(f"{key}={value}", f"&{group} {key}={shown(value)}: one value expected, found 2")
    refused(f"{key}={row.value}, {key}={row.value}", "the key is given twice")
    refused(f"{key}{key[-1]}={row.value}", f"unknown key; did you mean {key}?")
    refused(f"x{key}={row.value}", "unknown key; did you mean ")
    refused(f"{key}(1)={row.value}", "a key takes no index or component")
    refused(f"{key}%x={row.value}", "a key takes no index or component")
    # What has no = is one more value where the key before it has taken the place of a key.
    message = complaint(written(groups, row, key, f"{key} {row.value}"))
    assert re.match(rf"case\.nml:{line + 1}: &{group} {key}: expected '=' after the key", message) or re.match(
        rf"case\.nml:{line}: &{group} .*{key}.*: (must be |one value expected, found 3)", message
    ), message
    refused(f"{key}={row.value}, 0*{row.value}", "the number before * must be a whole number from 1 to")
    refused(f"{key}={row.value}, 3*", "a value is missing after *")
    refused(f"{key}={row.value},,{row.value}", "a value is missing next to a comma")
    if row.kind in ("text", "choice"):
        refused(f"{key}={row.value[:-1]}", f"&{group} {key}: the text has no closing '")
    if row.needed:
        refused(None, row.needed, line)


@pytest.mark.parametrize(("group", "key", "row"), ROWS, ids=[f"{group}-{key}" for group, key, _ in ROWS])
def test_what_is_right_is_taken(folder: Path, group: str, key: str, row: Row) -> None:
    groups = SCENES[row.scene]
    for value in right_values(row):
        if value in row.dear and not os.environ.get("MFV_DEEP"):
            continue
        message = complaint(written(groups, row, key, f"{key}={value}"))
        expected = row.refused.get(value, "")
        if expected:
            assert message.startswith("case.nml:") and any(part in message for part in expected.split("|")), (value, message)
        else:
            assert message == "", (value, message)


SOLVED = [key for key, row in CASE.items() if row.kind in ("real", "whole")]


@pytest.mark.parametrize("key", SOLVED, ids=[f"{group}-{key}" for group, key in SOLVED])
def test_extremes_end_with_a_result_or_a_message(folder: Path, tmp_path: Path, key: tuple[str, str]) -> None:
    """No trap (the debug preset traps invalid operations, divisions by zero and overflows), no hang, no NaN in a result."""
    row = CASE[key]
    faults: list[str] = []
    for place, value in enumerate(right_values(row)):
        if value not in row.dear:
            text = written(SCENES[row.scene], row, key[1], f"{key[1]}={value}")
            faults += [f"{value}: {fault}" for fault in faults_of_run(tmp_path / f"case{place}.nml", text)]
    assert not faults, "\n".join(faults)


def faults_of_run(case: Path, text: str) -> Iterator[str]:
    """What is wrong with how a run ends."""
    case.write_text(text)
    result = case.with_suffix(".h5")
    run = subprocess.run([RUN, case], cwd=case.parent, capture_output=True, text=True, timeout=300)
    if run.returncode not in (0, INPUT_ERROR, 3) or "Backtrace" in run.stderr or len(run.stderr.splitlines()) > 2:
        yield f"exit code {run.returncode}: {run.stderr}"
    elif (run.stderr == "") != (run.returncode == 0) or result.exists() != (run.returncode != INPUT_ERROR):
        yield f"exit code {run.returncode} with the message '{run.stderr}' and result {result.exists()}"
    elif result.exists():
        with h5py.File(result) as file:
            for group in ("state", "history", "mesh"):
                # The gap has no value beside a flat punch, nor has what is tangential where no shear is carried; edges are at
                # the outermost nodes of zones only, stresses along the surface at the ends of steps.
                yield from (
                    f"{group}/{name} is not finite (exit code {run.returncode}, {run.stderr.strip()})"
                    for name, dataset in file[group].items()
                    if not np.all(np.isfinite(dataset[()]))
                    and name not in ("gap", "initial_gap", "slip", "tangential_displacement", "contact_edge", "stick_edge")
                    and not name.endswith(("_surface_stress", "_tension", "_tension_x"))
                )
            certificate = file["certificate/largest"][()]
            if run.returncode == 0 and not certificate < 1e-9:
                yield f"certificate {certificate}"
