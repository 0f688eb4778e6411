"""The input of a result, a namelist text: its keys and values, and its case."""

from __future__ import annotations

import copy
import os
import re
from collections import Counter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .case import Case
    from .result import Result

#: Groups that may occur several times; their keys are named group(number)%key, as in a study.
REPEATED = ("body", "step")

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


def case_of(result: Result, *, keeping_states: bool = False) -> Case:
    """The case of a result, before its load history. `keeping_states`: save states even if the result has none, and those of all
    turning points of a load history.

    Raises ValueError if the scene had arrays in memory and the result is from a file, which does not contain them; InputError.
    """
    from .case import Case  # here, since they import this module
    from .scene import Output

    if result._source is not None:
        scene = copy.deepcopy(result._source)
        if keeping_states and scene.history is not None:
            scene.output = scene.output or Output()
            scene.output.states = "reversals"
        elif keeping_states and scene.output is not None and scene.output.states == "none":
            scene.output.states = "steps"
        return Case(scene)
    text = result.attributes["input"]
    in_memory = dict.fromkeys(_IN_MEMORY.findall(text))
    if in_memory:
        raise ValueError(
            f"arrays of the scene ({', '.join(in_memory)}) were given in memory and are not in the file; "
            "use the result object of the run for stresses and intermediate states"
        )
    if keeping_states and any(group == "history" for group, _ in groups(text)):
        text = _with_all_states(text)
    elif keeping_states:
        text = re.sub(r"(\bstates\s*=\s*)(['\"])none\2", r"\1\2steps\2", text, flags=re.IGNORECASE)
    name = os.path.join(result.attributes["working_directory"], result.attributes["input_file"])
    return Case.from_text(text, name)


def _with_all_states(text: str) -> str:
    """A namelist text whose run saves the states of all turning points."""
    import f90nml

    namelist = f90nml.reads(text)
    namelist.setdefault("output", f90nml.Namelist())["states"] = "reversals"
    return str(namelist)
