"""Backbone and cycles of growing amplitude of a scene, computed by MFV."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._datum import datums_of
from ..case import Case
from ..result import Group, Result
from ..scene import Scene, Solver, Step
from .backbone import Backbone

Array = NDArray[np.float64]

#: Amplitudes over the sliding limit by default.
RATIOS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)

#: The backbone goes on, displacement controlled, to twice the shift until no node sticks, at most this number of times.
DOUBLINGS = 12

#: A mesh refined for the cycles is continued on either side by this part of its length.
MARGIN = 0.25

#: Dissipation over force times displacement, of the amplitudes, up to which it is round-off: nothing slips. Likewise the tangential
#: force at the beginning, over the largest one.
ROUND_OFF = 1.0e-8


#: Difference of force between Masing's rules on first loading and a cycle, over the sliding force, above which first loading is not
#: used. It is below 0.02 where the contact remembers its turning points alone, and 0.08 or more after pressing with friction and full
#: coupling (docs/joints.md).
MEMORY = 0.04

#: The observable by which the mesh resolves a cycle.
DISSIPATION = "cycle_dissipation"


class Cycle(NamedTuple):
    """A closed cycle of tangential force, from +Q to -Q and back."""

    displacement: Array  #: at all events [length]
    force: Array  #: [force/length]
    dissipation: float  #: of this cycle [force], from MFV's own sum over the nodes that slip

    @property
    def amplitude(self) -> float:
        """Half the range of displacement [length]."""
        return float(0.5 * np.ptp(self.displacement))

    @property
    def force_amplitude(self) -> float:
        """Half the range of force [force/length]."""
        return float(0.5 * np.ptp(self.force))

    @property
    def stiffness(self) -> float:
        """Secant stiffness [force/length^2]."""
        return self.force_amplitude / self.amplitude

    @property
    def slips(self) -> bool:
        """Whether the dissipation is more than round-off."""
        return self.dissipation > ROUND_OFF * self.amplitude * self.force_amplitude

    def backbone(self) -> Backbone:
        """The branch after the turning point +Q at half its size: the backbone of a Masing model with this cycle.

        It has no sliding limit unless the cycle slides.
        """
        end = int(np.argmin(self.force))
        return _points(0.5 * (self.displacement[0] - self.displacement[: end + 1]), 0.5 * (self.force[0] - self.force[: end + 1]))


class Measurement(NamedTuple):
    """What models are fitted to and compared with."""

    backbone: Backbone  #: first loading after pressing, until all slides
    cycles: list[Cycle]  #: of growing amplitude, one after the other on the same contact
    warnings: tuple[str, ...] = ()  #: of the runs, those of cycles smaller than the largest after their force ratio
    unresolved: tuple[str, ...] = ()  #: observables that the mesh does not resolve in one of the cycles
    source: str = ""  #: the scene and its units

    @property
    def sliding_force(self) -> float:
        """The force at which all slides [force/length]."""
        return float(self.backbone.force[-1])

    def steady(self) -> Measurement:
        """The same cycles with the backbone of the largest one, continued as first loading goes on from its force.

        For a contact that remembers how the bodies were brought together, cycles of about this amplitude are predicted by it.
        """
        curve, first = self.cycles[-1].backbone(), self.backbone
        reached = float(np.interp(curve.force[-1], first.force, first.displacement))
        later = first.force > curve.force[-1] * (1.0 + 1.0e-9)
        displacement = np.append(curve.displacement, first.displacement[later] - reached + curve.displacement[-1])
        return self._replace(backbone=_points(displacement, np.append(curve.force, first.force[later])))


def measure(scene: Scene, force_ratios: Sequence[float] = RATIOS, *, repeats: int = 1) -> Measurement:
    """Shear a scene: a backbone up to sliding, and cycles between +Q and -Q of growing amplitude.

    `scene`: its steps bring the bodies together; the last of them with a normal quantity must prescribe `normal_force`, which is
    then constant. They may shear the bodies, but must end at a tangential force of 0. `force_ratios`: Q/(mu P), increasing, between
    0 and 1. `repeats`: cycles of every amplitude, of which the last is returned; with full coupling the first one differs. With
    refine='edges' in the mesh the intervals are small where slip zones end at these amplitudes; the backbone has the same mesh.
    Every event is a point (`stepping`='event'). If Masing's rules on first loading do not give the cycles, the
    backbone says so (`doubt`), and fits refuse it.
    Raises ValueError, InputError, and the exception of a run that ends early.
    """
    ratios = [float(ratio) for ratio in force_ratios]
    if not ratios or not all(0.0 < low < high < 1.0 for low, high in zip(ratios, [*ratios[1:], np.nextafter(1.0, 0.0)])):
        raise ValueError("force_ratios must increase, between 0 and 1")
    if repeats < 1:
        raise ValueError(f"repeats={repeats}: must be at least 1")
    _check(scene)
    if datums := datums_of(scene):
        raise ValueError(
            "measure needs a datum of the displacements that does not depend on the load, since it is a spring in series with the "
            f"contact: set datum in the elastic body (the default of this scene, its contact half-width, is {max(datums.values()):.6g})"
        )
    sheared = copy.deepcopy(scene)
    sheared.output = None
    sheared.solver = _by_events(scene)
    for ratio in ratios:
        sheared.steps += [Step(force_ratio=ratio), Step(force_ratio=-ratio, cycles=repeats)]
    result = sheared.run(check=True)
    origin = len(scene.steps)
    _check_origin(result.history, origin)
    cycles = [_last_cycle(result.history, origin, step) for step in range(origin + 2, origin + 2 * len(ratios) + 1, 2)]
    with _pressed(scene, result).contact() as contact:
        contact.run(check=True)
        warnings, unresolved = _doubts(contact, result, dict(zip(ratios, cycles)))
        backbone = _backbone(contact, origin, cycles[-1].force_amplitude)
    units = f"displacements [{result.mesh.unit('x')}], forces [{result.summary.unit('normal_force')}]"
    source = f"{result.title or scene.name}: {units}; {len(result.mesh.x)} nodes, mfv {result.attributes['mfv_version']}"
    return Measurement(backbone._replace(doubt=_doubt(backbone, cycles)), cycles, warnings, unresolved, source)


def _doubts(contact: Case, result: Result, cycles: dict[float, Cycle]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Warnings, and observables that are not resolved: of the largest cycle those of its `result`, of smaller ones, by their force ratio,
    until the mesh resolves their dissipation."""
    warnings, unresolved = list(result.warnings), set(result.unresolved)
    for ratio, cycle in list(cycles.items())[:-1]:
        with contact.trial():
            contact.advance(tangential_force=cycle.force_amplitude, check=True)
            contact.advance(tangential_force=-cycle.force_amplitude, cycles=1, check=True)
            small = contact.result()
        if DISSIPATION not in small.unresolved or DISSIPATION in result.unresolved:
            break
        warnings += [f"force ratio {ratio:g}: {text}" for text in small.warnings if DISSIPATION in text]
        unresolved.update(small.unresolved)
    return tuple(warnings), tuple(sorted(unresolved))


def _doubt(backbone: Backbone, cycles: list[Cycle]) -> str:
    """Why models of first loading would be wrong; nothing if Masing's rules on it give the unloading branches of the cycles."""
    worst = 0.0
    for cycle in cycles:
        end = int(np.argmin(cycle.force)) + 1
        shift, force = cycle.displacement[:end], cycle.force[:end]

        def loaded(displacement: Array | float) -> Array:
            return np.asarray(np.interp(displacement, backbone.displacement, backbone.force))

        expected = loaded(shift[0]) - 2.0 * loaded(0.5 * (shift[0] - shift))
        worst = max(worst, float(np.max(np.abs(expected - force))))
    worst /= float(backbone.force[-1])
    if worst < MEMORY:
        return ""
    return (
        f"first loading does not predict the cycles: by Masing's rules their forces would be off by {worst:.0%} of the sliding force, "
        "since the contact remembers how the bodies were brought together (friction while pressing, with coupling); use "
        "measured.steady(), which has the backbone of the largest cycle, or press with friction=False"
    )


def _check(scene: Scene) -> None:
    """Raises ValueError for a scene that cannot be measured."""
    solver = scene.solver
    if solver is not None and (solver.accuracy or solver.stepping == "leap"):
        raise ValueError("measure needs every event: remove accuracy and stepping='leap' from the solver")
    if solver is not None and solver.algorithm == "conventional":
        raise ValueError("measure needs every event, which algorithm='conventional' does not find: remove it from the solver")
    if scene.wear is not None:
        raise ValueError("measure needs surfaces that do not change: remove wear from the scene")
    if scene.history is not None:
        raise ValueError("measure shears the scene itself, after its steps: remove history from the scene")


def _check_origin(history: Group, origin: int) -> None:
    """Raises ValueError if the tangential force at the end of the step `origin` is more than round-off."""
    force = history.tangential_force[history.step <= origin][-1]
    if abs(force) > ROUND_OFF * np.max(np.abs(history.tangential_force)):
        raise ValueError(
            f"the steps of the scene end at the tangential force {force:.6g}: measure begins at 0; "
            "remove the step that shears, or add one with tangential_force=0"
        )


def _last_cycle(history: Group, origin: int, step: int) -> Cycle:
    """The last cycle of a step of a result; shifts are measured from the end of the step `origin`."""
    records = np.append(np.flatnonzero(history.step < step)[-1], np.flatnonzero(history.step == step))
    force = history.tangential_force[records]
    at_top = np.isclose(force, force[0], rtol=1.0e-9, atol=0.0)
    at_bottom = np.isclose(force, force.min(), rtol=1.0e-9, atol=0.0)
    begin = np.flatnonzero(at_top[: np.flatnonzero(at_bottom)[-1]])[-1]
    records = records[begin:]
    shift = history.shift[records] - history.shift[history.step <= origin][-1]
    lost = history.dissipation[records]
    return Cycle(shift, force[begin:], float(lost[-1] - lost[0]))


def _pressed(scene: Scene, result: Result) -> Scene:
    """A scene on the mesh of a result that shears it."""
    pressed = copy.deepcopy(scene)
    pressed.output = None
    pressed.solver = _by_events(scene)
    if pressed.mesh is not None and pressed.mesh.refine == "edges":
        others = {"refine": None, "nodes": None, "half_width": None, "half_angle": None}
        pressed.mesh = dataclasses.replace(pressed.mesh, ends=_wider(result.mesh), **others)
    return pressed


def _backbone(contact: Case, steps: int, force: float) -> Backbone:
    """First loading of a contact after its `steps`, to a force, and on until all slides."""
    origin = contact.loads
    contact.advance(tangential_force=force, check=True)
    for _ in range(DOUBLINGS):
        contact.advance(shift=contact.loads.shift - origin.shift, relative=True, check=True)
        if contact.loads.stick_nodes == 0:
            break
    history = contact.result().history
    sheared = np.append(np.flatnonzero(history.step <= steps)[-1], np.flatnonzero(history.step > steps))
    forces = history.tangential_force[sheared]
    forces[0] = 0.0  # it may be round-off
    return _points(history.shift[sheared] - origin.shift, forces)


def _by_events(scene: Scene) -> Solver:
    """The solver of a scene, but with every event."""
    return dataclasses.replace(scene.solver or Solver(), accuracy=None, stepping="event")


def _wider(mesh: Group) -> Array:
    """The ends of the intervals of a mesh, and of more intervals on either side: with coupling the contact moves until all slides."""
    ends = np.append(mesh.x[0] - 0.5 * mesh.width[0], mesh.x + 0.5 * mesh.width)
    more = np.linspace(0.0, MARGIN * np.ptp(ends), 17)[1:]
    return np.concatenate((ends[0] - more[::-1], ends, ends[-1] + more))


def _points(displacement: Array, force: Array) -> Backbone:
    """The backbone through points whose displacements increase, apart from repeated ones and round-off."""
    least = 1.0e-12 * displacement[-1]
    kept = [0]
    for point in range(1, displacement.size):
        if displacement[point] > displacement[kept[-1]] + least:
            kept.append(point)
    rising = np.maximum.accumulate(force[kept])
    if np.max(rising - force[kept]) > 1.0e-9 * rising[-1]:
        raise ValueError(
            "the tangential force falls while the displacement grows (weakening, stress drops): no joint model has such a backbone"
        )
    return Backbone.of(displacement[kept], rising)
