"""The case of a result once more, before its load history."""

from __future__ import annotations

import copy
import os
import re

from .case import Case
from .result import Result

#: The comment with which an input names the arrays that its scene had in place of a file.
_IN_MEMORY = re.compile(r"^! '(.*)' was given in memory: ", flags=re.MULTILINE)


def case_of(result: Result, *, keeping_states: bool = False) -> Case:
    """The case of a result, as it was before its load history. `keeping_states`: also where the result keeps none.

    Raises ValueError where arrays of the scene were in memory and the result is from a file, which has them not; InputError.
    """
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
    name = os.path.join(result.attributes["working_directory"], result.attributes["input_file"])
    return Case.from_text(_keeping_states(text) if keeping_states else text, name)


def _keeping_states(text: str) -> str:
    """The text of a case that keeps states, also where it says that it keeps none."""
    return re.sub(r"(\bstates\s*=\s*)(['\"])none\2", r"\1\2steps\2", text, flags=re.IGNORECASE)
