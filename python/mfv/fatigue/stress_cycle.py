"""Stresses at points of a body over a whole load cycle."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..inputs import groups
from ..load_history import LOADS, kept_states, stages
from ..result import Result
from ..stress import BODIES, contact_edges, stress, surface

Array = NDArray[np.float64]

#: The stresses of a cycle, in this order along the last dimension.
COMPONENTS = ("sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz")

#: Observables that are in doubt if the stresses of a body are: {} is its name.
STRESSES = ("peak_pressure", "peak_shear", "{}_tension", "largest_{}_tension", "largest_{}_von_mises")

#: States are equal if their loads and tractions differ by less, relative to the ranges over the load history.
EQUAL_STATES = 1.0e-3

#: A load whose range is smaller, relative to its largest value, is constant.
CONSTANT = 1.0e-6

#: A point is at an interface if its depth differs by less, relative to it.
ROUND_OFF = 4.0 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class StressCycle:
    """Stresses over a cycle at the points (x, y), lengths, of any shape; `stress` has the shape (states, *shape, 4) and the components
    sigma_xx, sigma_yy, sigma_xy, sigma_zz [force/length^2], tension positive. The body is isotropic with a `shear_modulus`
    [force/length^2] and a `poisson_ratio`. `units`: names of those of lengths and stresses, for pictures. Stresses from anywhere will do.
    """

    x: Array
    y: Array
    stress: Array
    shear_modulus: float
    poisson_ratio: float
    units: tuple[str, str] = ("", "")

    def __post_init__(self) -> None:
        for name in ("x", "y", "stress"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))
        if self.stress.shape[1:] != (*self.x.shape, len(COMPONENTS)) or self.y.shape != self.x.shape or len(self.stress) < 2:
            raise ValueError(
                f"stress must have the shape (states, *x.shape, 4) with at least two states, not {self.stress.shape} for "
                f"{self.x.shape} points"
            )

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus [force/length^2]."""
        return 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio)

    @property
    def hydrostatic(self) -> Array:
        """Hydrostatic stress, a third of the trace [force/length^2], shape (states, *shape)."""
        return np.asarray((self.stress[..., 0] + self.stress[..., 1] + self.stress[..., 3]) / 3.0)

    def average(self, weights: ArrayLike) -> StressCycle:
        """The cycle of the weighted average of the stresses at all points, a single one at the average position. `weights`: shape
        (points), sum 1."""
        share = np.asarray(weights, dtype=np.float64)
        if share.shape != self.x.shape:
            raise ValueError(f"weights must have the shape of the points {self.x.shape}, not {share.shape}")
        every = tuple(range(share.ndim))
        averaged = np.tensordot(self.stress, share, axes=([axis + 1 for axis in every], every))
        x, y = (np.asarray(np.sum(share * values)) for values in (self.x, self.y))
        return dataclasses.replace(self, x=x, y=y, stress=averaged)


def stress_cycle(
    result: Result, x: ArrayLike, y: ArrayLike, *, body: str = "lower", states: Sequence[int] | None = None
) -> StressCycle:
    """Stresses of a body at the points (x, y), lengths, y up from the contact, over the last cycle of a result.

    `body`: 'lower' or 'upper'. `states`: the numbers in `result.steps`, from 1, of the states of the cycle; those of `last_cycle` by
    default. The states of a result are its turning points; `mfv.load_history.with_states_between` computes more, which a cycle out of
    phase needs. Elastic constants are those of the layer of the points. Raises ValueError for points in several materials, for an
    anisotropic one, and as `last_cycle` and as `mfv.stress.stress`. Warns if the mesh does not resolve the stresses of the body.
    """
    across, up = (np.array(values, dtype=np.float64) for values in np.broadcast_arrays(x, y))
    shear_modulus, poisson_ratio = _constants(result, body, up)
    warn_of_doubt(result, *(name.format(body) for name in STRESSES))
    numbers = last_cycle(result) if states is None else tuple(states)
    result = kept_states(result)
    fields = [stress(result, across, up, body=body, step=number) for number in numbers]
    components = [np.stack([field[name].reshape(across.shape) for name in COMPONENTS], axis=-1) for field in fields]
    units = result.mesh.unit("x"), result.state.unit("pressure")
    return StressCycle(across, up, np.stack(components), shear_modulus, poisson_ratio, units)


def warn_of_doubt(result: Result, *names: str) -> None:
    """A Python warning with those of these observables that the mesh does not resolve, if there are any."""
    doubtful = [name for name in names if name in result.unresolved]
    if doubtful:
        warnings.warn(
            f"the mesh does not resolve {', '.join(doubtful)}, on which fatigue depends: see the result's warnings", stacklevel=3
        )


def _constants(result: Result, body: str, y: Array) -> tuple[float, float]:
    """Shear modulus [force/length^2] and Poisson's ratio of a body where its points are at y. Raises ValueError for points in several
    materials, or in an anisotropic one."""
    name, about = _material(result, body, y)
    if f"{name}_compliance_11" in result.scene:
        raise ValueError(
            f"{about} is anisotropic: pass its stresses (mfv.stress.stress) and the constants of an isotropic material to "
            "mfv.fatigue.StressCycle"
        )
    return float(result.scene[f"{name}_shear_modulus"]), float(result.scene[f"{name}_poisson_ratio"])


def _material(result: Result, body: str, y: Array) -> tuple[str, str]:
    """The material of a body where its points are at y: the beginning of its names in `result.scene`, and its name for messages. Raises
    ValueError for points in several materials."""
    if body not in BODIES:
        raise ValueError(f"body must be 'lower' or 'upper', not '{body}'")
    scene, about = result.scene, f"the {body} body"
    layers = range(1, int(scene.get(f"{body}_layers", 0)) + 1)
    if not layers:
        return body, about
    materials = [(f"{body}_layer_{number}", f"layer {number} of {about}") for number in layers]
    if any(name.startswith(f"{body}_base_") for name in scene):
        materials.append((f"{body}_base", f"{about} below its layers"))
    depth = -y if body == "lower" else y
    interfaces = np.cumsum([scene[f"{name}_thickness"] for name, _ in materials[: len(layers)]])
    # At an interface stresses are those of the layer above it.
    number = np.searchsorted(interfaces * (1.0 + ROUND_OFF), depth[depth >= 0.0])
    found = np.unique(number[number < len(materials)])
    if found.size > 1:
        raise ValueError(
            f"the points are in {' and '.join(materials[place][1] for place in found)}: strains and lives are those of one material; choose "
            f"points between two interfaces, which are at the depths {', '.join(f'{depth:.6g}' for depth in interfaces)}"
        )
    return materials[found[0]] if found.size else materials[0]


def last_cycle(result: Result) -> tuple[int, ...]:
    """Numbers in `result.steps`, from 1, of the states of the last cycle; the last one is also the state in which it begins.

    The cycle is that of the last step if it has `cycles`, or of a &history that is repeated. Otherwise it consists of the states after
    the latest one with the prescribed loads and motions and the tractions of the last, reached in the same direction, if these include
    the extremes of everything prescribed. Raises ValueError if there is no such cycle, or if its states are not in the result.
    """
    kept = kept_states(result)
    every = [stage for stage in stages(kept) if stage.step]
    same = [stage for stage in every if stage.step == every[-1].step]
    cycles = [stage for stage in same if stage.is_cycle]
    if cycles and not cycles[-1].is_first:
        return tuple(cycles[-1].states)
    if not cycles and same and int(kept.steps[same[-1].states[-1] - 1].reversal) > 1:
        raise ValueError(
            f"the {len(kept.steps)} states in /steps do not contain a whole cycle of the last step; save its turning points by "
            "states='last_cycle' in &output, compute them by mfv.load_history.with_states_between, or name the states by their numbers"
        )
    closed = _closed_loop(kept)
    if not closed:
        raise ValueError(
            f"the {len(kept.steps)} states in /steps do not contain a closed cycle: no earlier state has the loads, motions and "
            "tractions of the last one with all extremes in between; repeat the cycle (cycles=2 in &step or &history) and save its "
            "turning points (states='last_cycle' in &output), or name the states of the cycle by their numbers"
        )
    return closed


def _closed_loop(result: Result) -> tuple[int, ...]:
    """Numbers in `result.steps`, from 1, of the states of a cycle that ends with the last state, without the state in which it begins.
    Empty if no earlier state equals the last one, or if a prescribed load has an extreme outside the states in between."""
    states, names = result.steps, _prescribed(result)
    segments = [(int(state.get("step", 0)), int(state.get("reversal", 0))) for state in states]
    ends = [number for number, segment in enumerate(segments) if segments[number + 1 : number + 2] != [segment]]
    loads = np.array([[float(state.get(name, 0.0)) for name in names] for state in states])
    ranges = np.ptp(loads[ends], axis=0)
    varies = ranges > CONSTANT * np.max(np.abs(loads), axis=0)
    tractions = np.array([np.concatenate([state.pressure, state.shear]) for state in states])
    change = np.max(np.ptp(tractions[ends], axis=0))
    if not np.any(varies) or change == 0.0:
        return ()
    loads = loads[:, varies] / ranges[varies]
    difference = np.max(np.abs(np.column_stack([loads - loads[-1], (tractions - tractions[-1]) / change])), axis=1)
    increments = np.diff(loads, axis=0, prepend=loads[:1])
    is_equal = (difference <= EQUAL_STATES) & (increments @ increments[-1] >= 0.0)
    for first in range(len(states) - 3, -1, -1):
        loop = loads[first:]
        is_nearest = first == 0 or difference[first - 1] >= difference[first]
        if is_equal[first] and is_nearest and np.all(np.ptp(loop, axis=0) >= 1.0 - EQUAL_STATES):
            return tuple(range(first + 2, len(states) + 1))
    return ()


def _prescribed(result: Result) -> list[str]:
    """Names of the loads and motions that a case prescribes. Where its input does not say which (steps by a host, a history in a file):
    all but moments, which vary by round-off."""
    parts = groups(result.attributes["input"])
    steps = [values for name, values in parts if name in ("step", "history")]
    last = max(int(state.get("step", 0)) for state in result.steps)
    is_of_host = last > len(steps) and all(name != "history" for name, _ in parts)
    if is_of_host or any("file" in step for step in steps):
        return [name for name in LOADS if name in result.steps[0] and name != "moment"]
    keys = {"tangential_force" if key == "force_ratio" else key for step in steps for key in step}
    return [name for name in LOADS if name in keys]


def graded_points(result: Result, *, body: str = "lower", depth: float = 1.0, finest: float = 1.0e-4) -> tuple[Array, Array]:
    """Points (x, y) of a body, concentrated at the surface and at the edges of contact, where stresses vary like a square root; arrays
    (down, across).

    `depth`: below the surface, in half-widths of the contact; to either side, a half-width beyond the edges. `finest`: the smallest
    distance from an edge and from the surface, in half-widths. Raises ValueError without load, or for another body.
    """
    if body not in BODIES:
        raise ValueError(f"body must be 'lower' or 'upper', not '{body}'")
    edges = contact_edges(result, body)
    if edges.size < 2:
        raise ValueError("no load in the last state")
    half = 0.5 * (edges[-1] - edges[0])
    away = half * np.logspace(np.log10(finest), 0.0, 25)
    regular = np.linspace(edges[0] - half, edges[-1] + half, 81)
    across = np.unique(np.concatenate([regular, edges, *(edge + sign * away for edge in edges for sign in (-1.0, 1.0))]))
    down = half * np.concatenate([[0.0], np.logspace(np.log10(finest), np.log10(depth), 40)])
    x, below = np.meshgrid(across, down)
    return x, inside(result, body, x, below)


def inside(result: Result, body: str, x: Array, depth: Array) -> Array:
    """y of points of a body at a `depth` below its surface, lengths."""
    y = surface(result, body, x) - depth
    return y if body == "lower" else -y
