"""The input of a result, a namelist text: its keys and values."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

#: Groups that may occur several times; their keys are named group(number)%key, as in a study.
REPEATED = ("body", "layer", "step")

#: The comment in an input that names an array given in memory.
_IN_MEMORY = re.compile(r"^! '(.*)' was given in memory: ", flags=re.MULTILINE)


def keys(text: str) -> dict[str, Any]:
    """Values of a namelist text by key, as in studies, such as 'scene%coupling' and 'step(2)%cycles': numbers, texts, logicals,
    or lists of them. Raises ValueError for an invalid namelist."""
    found: dict[str, Any] = {}
    numbers: Counter[str] = Counter()
    for group, values in groups(text):
        numbers[group] += 1
        place = f"{group}({numbers[group]})" if group in REPEATED else group
        found.update({f"{place}%{key}": value for key, value in values.items()})
    return found


def groups(text: str) -> list[tuple[str, dict[str, Any]]]:
    """Name, keys and values of every group of a namelist text, groups of one name in their order. Raises ValueError."""
    import f90nml

    try:
        namelist = f90nml.reads(text)
    except Exception as error:  # f90nml raises exceptions of many types
        raise ValueError(f"f90nml cannot read the input as a namelist: {error}") from error
    return [
        (name, dict(values))
        for name in namelist
        for values in (namelist[name] if isinstance(namelist[name], list) else [namelist[name]])
    ]


def arrays_in_memory(text: str) -> list[str]:
    """Names of the arrays of a scene that were given in memory and are not in its namelist text."""
    return list(dict.fromkeys(_IN_MEMORY.findall(text)))


def keeping_states(text: str) -> str:
    """A namelist text whose run saves states, too, if it saves none: those of all turning points of a load history."""
    if any(group == "history" for group, _ in groups(text)):
        return _with_all_states(text)
    return re.sub(r"(\bstates\s*=\s*)(['\"])none\2", r"\1\2steps\2", text, flags=re.IGNORECASE)


def _with_all_states(text: str) -> str:
    """A namelist text whose run saves the states of all turning points."""
    import f90nml

    namelist = f90nml.reads(text)
    namelist.setdefault("output", f90nml.Namelist())["states"] = "reversals"
    return str(namelist)
