"""The smallest problem that still shows a finding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from .problem import Problem

#: Trials after which a problem is small enough.
MOST_TRIALS = 120
#: Digits of numbers, tried in this order.
DIGITS = (1, 2, 3, 4)


def shrunk(problem: Problem, shows: Callable[[Problem], bool], most: int = MOST_TRIALS) -> Problem:
    """The problem with fewer groups, keys, rows and digits, as long as `shows` is true of it."""
    trials = 0
    again = True
    while again and trials < most:
        again = False
        for smaller in _smaller(problem):
            trials += 1
            if trials > most:
                break
            if smaller.text() + str(smaller.tables) != problem.text() + str(problem.tables) and shows(smaller):
                problem, again = smaller, True
                break
    return problem


def _smaller(problem: Problem) -> Iterator[Problem]:
    """Problems that are smaller by one thing, the largest things first."""
    for place, (group, keys) in enumerate(problem.groups):
        if group in ("solver", "wear", "history") or (group == "step" and len(problem.all("step")) > 1):
            yield _without_group(problem, place)
        if "cycles" in keys:
            for cycles in (None, keys["cycles"] // 2, keys["cycles"] - 1):
                if cycles is None or cycles > 0:
                    yield _with(problem, place, "cycles", cycles)
    for file, table in problem.tables.items():
        yield from _shorter(problem, file, table)
    for place, (group, keys) in enumerate(problem.groups):
        for key in keys:
            if group != "output" and key not in ("shape", "law", "mu", "file", "nodes"):
                yield _with(problem, place, key, None)
    for place, (group, keys) in enumerate(problem.groups):
        for key, value in keys.items():
            if isinstance(value, float) and group != "output":
                for digits in DIGITS:
                    rounded = float(f"{value:.{digits}g}")
                    if rounded == value:
                        break
                    yield _with(problem, place, key, rounded)


def _without_group(problem: Problem, place: int) -> Problem:
    made = problem.copy()
    del made.groups[place]
    return made


def _with(problem: Problem, place: int, key: str, value: Any) -> Problem:
    """With another value of a key, or without it."""
    made = problem.copy()
    keys = made.groups[place][1]
    if value is None:
        del keys[key]
    else:
        keys[key] = value
    return made


def _shorter(problem: Problem, file: str, table: dict[str, list[float]]) -> Iterator[Problem]:
    """With half the rows of a load history, or half the points of a profile."""
    rows = len(next(iter(table.values())))
    parts = [slice(0, rows // 2), slice(rows // 2, rows), slice(0, rows - 1)] if file == "signal.csv" else [slice(0, rows, 2)]
    for part in parts:
        if len(range(rows)[part]) >= 2:
            made = problem.copy()
            made.tables[file] = {name: column[part] for name, column in table.items()}
            yield made
