"""States along a load history: those saved in a result, or more of them by solving its case again."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from .case import case_of
from .compare import compare
from .errors import MfvError
from .inputs import groups
from .loads import MOTIONS
from .result import Field, Group, Result, is_last

#: Keys of a step that prescribe a load or a displacement.
LOADS = tuple(key for motion in MOTIONS for key in motion.targets)

#: Keys of a step that this module knows; a step with any other cannot be divided.
KNOWN = (*LOADS, "force_ratio", "friction", "cycles", "steady_tolerance")

#: Tolerance of the tractions at the end, relative to the largest traction: beyond it there is a note.
AGREEMENT = 1.0e-9

#: Beyond this difference the steps of the case did not produce the result.
LIKENESS = 1.0e-2

#: The note on a case with &history.
BETWEEN_ROWS = "states between the turning points of &history are not computed; for more states add rows to it"

Progress = Callable[[Iterable[Any]], Iterable[Any]]


class Part(NamedTuple):
    """A load segment: targets of the loads; segments of return go to the loads at the beginning of the step."""

    step: int
    #: Its number in the step, from 1.
    reversal: int
    targets: dict[str, float]
    friction: bool
    #: The loads at which it ended early.
    reached: dict[str, float] | None = None

    @property
    def is_back(self) -> bool:
        """Whether it returns to the loads at the beginning of the step."""
        return self.reversal % 2 == 0


class Stage(NamedTuple):
    """The states of one cycle, or a single state outside cycles."""

    #: Numbers in `result.steps`, from 1.
    states: list[int]
    #: Whether it is a cycle with all of its turning points.
    is_cycle: bool = False
    #: Whether it is the first cycle of &history, which may begin at other loads than it ends.
    is_first: bool = False
    #: The step, 0 for a state at which the run ended early.
    step: int = 0


class LoadHistory(NamedTuple):
    """A result with a state in `steps` for every picture, and a note for the user, or an empty text."""

    result: Result
    note: str


def kept_states(result: Result) -> Result:
    """A result whose `steps` end with its last state, also if the run ended early or has not begun."""
    if result.steps and is_last(result, result.steps[-1]):
        return result
    loads = {name: _field(result.summary, name) for name in result.summary if name not in result.state}
    last = Group({**{name: _field(result.state, name) for name in result.state}, **loads})
    longer = copy.copy(result)
    longer.steps = [*result.steps, last]
    return longer


def stages(result: Result) -> list[Stage]:
    """The states of a result in `steps` by cycles."""
    turns, of_history = _turns(result)
    found: list[Stage] = []
    passed: list[set[int]] = []
    last_turn = 0
    for number, state in enumerate(result.steps, start=1):
        step = int(state.get("step", 0))
        size = turns.get(step, 0)
        turn = (int(state.reversal) - 1) % size if size else 0
        if not size or not found or step != found[-1].step or turn < last_turn:
            found.append(Stage([], is_first=step == of_history > 0 and int(state.reversal) <= size, step=step))
            passed.append(set())
        found[-1].states.append(number)
        passed[-1].add(turn)
        last_turn = turn
    return [stage._replace(is_cycle=len(seen) == turns.get(stage.step, 0)) for stage, seen in zip(found, passed)]


def _turns(result: Result) -> tuple[dict[int, int], int]:
    """Number of turning points of a cycle, by step with cycles, 0 if unknown; and which of these steps is of &history, 0 if none."""
    ends: dict[int, int] = {}
    for state in result.steps:
        if "step" in state:
            ends[int(state.step)] = max(int(state.reversal), ends.get(int(state.step), 0))
    turns = {step: 2 for step, reversal in ends.items() if reversal > 1}
    try:
        parts = groups(result.attributes["input"])
    except ValueError:
        return {}, 0
    steps = sum(name == "step" for name, _ in parts)
    history = next((values for name, values in parts if name == "history"), None)
    of_history = min((step for step in turns if step > steps), default=0) if history is not None else 0
    if history is not None and of_history:
        turns[of_history] = _period(result, history, of_history, ends)
    return turns, of_history


def _period(result: Result, history: dict[str, Any], step: int, ends: dict[int, int]) -> int:
    """Number of turning points in the cycle of &history, 0 if unknown. `ends`: the last reversal of every step."""
    lists = [len(value) for value in history.values() if isinstance(value, list)]
    if "period" in history or lists:
        return int(history.get("period", max(lists, default=0)))
    cycles = result.cycles
    if result.outcome != "complete" or "step" not in cycles or cycles.step[-1] != step:
        return 0
    # All rows of a file are the cycle: their number follows from that of the cycles.
    done = int(cycles.cycle[-1]) + (int(cycles.block[-1]) - 1 if "block" in cycles else 0)
    done -= sum(reversal // 2 for other, reversal in ends.items() if other < step)
    return ends[step] // max(done, 1)


def thinned(result: Result, states: int) -> Result:
    """A result with at most `states` of its states in `steps`: whole cycles, including the last one, and the last state.

    If there are too few states for that, states evenly spaced.
    """
    if len(result.steps) <= states:
        return result
    every = stages(result)
    for count in range(min(len(every), states), 0, -1):
        chosen = [number for stage in _some(every, count) for number in stage.states]
        if len(chosen) <= states:
            break
    else:
        chosen = [int(number) + 1 for number in evenly(len(result.steps), states)]
    thinner = copy.copy(result)
    thinner.steps = [result.steps[number - 1] for number in chosen]
    return thinner


def _some(every: list[Stage], count: int) -> list[Stage]:
    """About `count` stages, evenly spaced, including the last one and the last cycle."""
    chosen = {len(every) - 1 - int(number) for number in evenly(len(every), count)}
    chosen.update([number for number, stage in enumerate(every) if stage.is_cycle][-1:])
    return [every[number] for number in sorted(chosen)]


def _thinned_to_the_last_cycle(result: Result, states: int) -> Result:
    """A result with at most `states` of its states in `steps`, or with its last cycle and last state if they are more."""
    every = stages(result)
    return thinned(result, max(states, sum(len(stage.states) for stage in _some(every, 1)))) if every else result


def evenly(size: int, most: int) -> np.ndarray:
    """At most `most` indices below `size`, evenly spaced, including the first and the last."""
    return np.unique(np.linspace(0, size - 1, min(size, most)).round().astype(int))


def with_states_between(result: Result, states: int, progress: Progress = iter) -> LoadHistory:
    """The load history of a result with about `states` states, from its case solved again with intermediate targets.

    If that fails, or ends in another state, the states saved in the result, with a note that says why. There is also a note if
    the last states differ by more than AGREEMENT times the largest traction of all states. `progress` wraps the targets.
    A case with &history has the states at its turning points, and a note that there are none in between. If there are more states
    than `states`, whole cycles are omitted, but never the last one.
    """
    kept = kept_states(result)
    try:
        again = _solved_again(result, states, progress)
    except (MfvError, ValueError) as error:
        return LoadHistory(_thinned_to_the_last_cycle(kept, states), f"only the states saved in the file are shown: {error}")
    difference = _difference_of_ends(result, again, [*kept.steps, *again.steps])
    elsewhere = f"the case solved again ends in a different state: tractions differ by {difference:.1e} of the largest"
    if not difference <= LIKENESS:
        return LoadHistory(_thinned_to_the_last_cycle(kept, states), f"only the states saved in the file are shown: {elsewhere}")
    notes = [] if difference <= AGREEMENT else [elsewhere]
    if _has_history(result):
        notes.append(BETWEEN_ROWS)
    return LoadHistory(again, "; ".join(notes))


def _has_history(result: Result) -> bool:
    """Whether the case of a result has &history."""
    return any(name == "history" for name, _ in groups(result.attributes["input"]))


def _difference_of_ends(result: Result, again: Result, states: Sequence[Group]) -> float:
    """The largest difference of a traction between the last states, relative to the largest one of all states."""
    ends = compare(result, again)
    difference = ends.largest_difference * max(max(traction.first, traction.second) for traction in ends.tractions)
    largest = max(float(np.max(np.abs(state[name]))) for state in states for name in ("pressure", "shear"))
    return difference / largest if difference != 0.0 else 0.0


def _solved_again(result: Result, states: int, progress: Progress) -> Result:
    """The result of a case solved again with intermediate states. Raises MfvError, ValueError."""
    if result.attributes["algorithm"] != "mfv":
        raise ValueError("the conventional algorithm depends on the load steps, which additional states would change")
    if _has_history(result):
        return _with_turning_points(result, states)
    parts = list(_parts(result))
    if result.outcome != "complete" and parts:
        reached = {name: float(result.summary[name]) for name in parts[-1].targets}
        parts[-1] = parts[-1]._replace(reached=reached)
    divisions = states // max(len(parts), 1)
    if divisions < 2:
        raise ValueError(f"{len(parts)} load segments need at least {2 * len(parts)} states")
    divided = [(part, division / divisions) for part in parts for division in range(1, divisions + 1)]
    began: dict[int, dict[str, float]] = {}
    advanced: list[Part] = []
    with case_of(result, keeping_states=True) as case:
        start: dict[str, float] = {}
        for part, share in progress(divided):
            if share == 1.0 / divisions:
                start = {name: float(case[f"summary/{name}"]) for name in part.targets}
                began.setdefault(part.step, start)
            ends = began[part.step] if part.is_back else part.targets
            loads: dict[str, Any] = _loads_at(share, part, start, ends)
            if case.advance(friction=part.friction, **loads) != "complete":
                break
            advanced.append(part)
        again = case.result()
        again.steps = [_of_part(state, part) for state, part in zip(again.steps, advanced)]
        return kept_states(again)


def _of_part(state: Group, part: Part) -> Group:
    """A state with the step and the reversal of its load segment in the original case."""
    fields = {name: state._field(name) for name in state}
    for name, number in (("step", part.step), ("reversal", part.reversal)):
        fields[name] = fields[name]._replace(values=np.int32(number))
    return Group(fields, state._coordinates)


def _with_turning_points(result: Result, states: int) -> Result:
    """The result of a case with a load history solved again, with the states at its turning points, of at most `states` if the last
    cycle has no more."""
    with case_of(result, keeping_states=True) as case:
        case.run()
        return _thinned_to_the_last_cycle(kept_states(case.result()), states)


def _loads_at(share: float, part: Part, start: dict[str, float], ends: dict[str, float]) -> dict[str, float]:
    """The loads at a fraction of a segment. A segment that ended early is divided up to its end; the last division has the
    targets of the segment, so that it ends early again."""
    if share == 1.0:
        return {name: ends[name] for name in part.targets}
    shown = part.reached or ends
    return {name: start[name] + share * (shown[name] - start[name]) for name in part.targets}


def _parts(result: Result) -> Iterator[Part]:
    """The load segments of a result, including the one that ended early."""
    steps = [values for name, values in groups(result.attributes["input"]) if name == "step"]
    done = int(result.summary.steps_done)
    normal_force = 0.0
    for number, step in enumerate(steps[: done + (result.outcome != "complete")], start=1):
        unknown = [key for key in step if key not in KNOWN]
        if unknown:
            raise ValueError(f"&step {unknown[0]}: a step with this key cannot be divided")
        normal_force = step.get("normal_force", normal_force)
        targets = {name: float(step[name]) for name in LOADS if name in step}
        if "force_ratio" in step:
            targets["tangential_force"] = step["force_ratio"] * float(np.max(result.mesh.static_friction)) * normal_force
        for reversal in range(1, _reversals(result, number, step, number <= done) + 1):
            yield Part(number, reversal, targets, bool(step.get("friction", True)))


def _reversals(result: Result, number: int, step: dict[str, Any], is_done: bool) -> int:
    """Number of load segments of a step in a result, including the one that ended early."""
    cycles = step.get("cycles", 0)
    if cycles == 0:
        return 1
    kept = max((int(state.reversal) for state in result.steps if state.step == number), default=0)
    if not is_done:
        return kept + 1
    if kept == 0 and "steady_tolerance" in step:
        raise ValueError(f"step {number} ended at a steady state, and the file does not contain the number of cycles")
    return kept or 2 * cycles


def _field(group: Group, name: str) -> Field:
    return Field(group[name], group.unit(name), group.description(name))
