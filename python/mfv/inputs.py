"""The input of a result, a namelist text: its keys and values, and the case that it describes."""

from __future__ import annotations

import copy
import os
import re
from collections import Counter
from typing import TYPE_CHECKING, Any

import f90nml

if TYPE_CHECKING:
    from .case import Case
    from .result import Result

#: Groups that may come more than once; their keys are named group(number)%key, as in a study.
REPEATED = ("body", "step")

#: The comment with which an input names the arrays that its scene had in place of a file.
_IN_MEMORY = re.compile(r"^! '(.*)' was given in memory: ", flags=re.MULTILINE)


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


def case_of(result: Result, *, keeping_states: bool = False) -> Case:
    """The case of a result, as it was before its load history. `keeping_states`: also where the result keeps none.

    Raises ValueError where arrays of the scene were in memory and the result is from a file, which has them not; InputError.
    """
    from .case import Case  # here: cases are made of scenes, which read inputs

    if result._source is not None:
        scene = copy.deepcopy(result._source)
        if keeping_states and scene.output is not None and scene.output.states == "none":
            scene.output.states = "steps"
        return Case(scene)
    text = result.attributes["input"]
    in_memory = dict.fromkeys(_IN_MEMORY.findall(text))
    if in_memory:
        raise ValueError(
            f"arrays of the scene ({', '.join(in_memory)}) were given in memory and are not in the file: "
            "stresses and states in between need the result that the run itself gave"
        )
    if keeping_states:
        text = re.sub(r"(\bstates\s*=\s*)(['\"])none\2", r"\1\2steps\2", text, flags=re.IGNORECASE)
    name = os.path.join(result.attributes["working_directory"], result.attributes["input_file"])
    return Case.from_text(text, name)
