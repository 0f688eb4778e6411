"""The input of a result, a namelist text, as keys and values."""

from __future__ import annotations

from collections import Counter
from typing import Any

import f90nml

#: Groups that may come more than once; their keys are named group(number)%key, as in a study.
REPEATED = ("body", "step")


def keys(text: str) -> dict[str, Any]:
    """Values of a namelist text by the names that studies have for them, such as 'scene%coupling' and 'step(2)%cycles':
    numbers, texts, logicals, or lists of them. Raises ValueError for a text that is no namelist."""
    found: dict[str, Any] = {}
    numbers: Counter[str] = Counter()
    for group, values in groups(text):
        numbers[group] += 1
        place = f"{group}({numbers[group]})" if group in REPEATED else group
        found.update({f"{place}%{key}": value for key, value in values.items()})
    return found


def groups(text: str) -> list[tuple[str, dict[str, Any]]]:
    """Name, keys and values of every group of a namelist text, those of one name in their order. Raises ValueError."""
    try:
        namelist = f90nml.reads(text)
    except Exception as error:  # f90nml has no exception of its own for a text that it cannot read
        raise ValueError(f"the input is no namelist that f90nml can read: {error}") from error
    return [
        (name, dict(values))
        for name in namelist
        for values in (namelist[name] if isinstance(namelist[name], list) else [namelist[name]])
    ]
