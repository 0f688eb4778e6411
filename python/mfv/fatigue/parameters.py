"""Multiaxial fatigue parameters of a stress cycle: Smith-Watson-Topper, Fatemi-Socie, Findley, Crossland, Dang Van; Ruiz's of a result.

Critical planes are searched in all directions: perpendicular to the plane of the model and tilted out of it. Shear on a tilted plane has two
components; its amplitude is half the longest chord of its path, the largest amplitude along any direction on the plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Callable, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..codes import NodeStatus
from ..load_history import kept_states
from ..result import Result
from ..stress import surface_nodes
from .stress_cycle import StressCycle, last_cycle, stress_cycle, warn_of_doubt

Array = NDArray[np.float64]

#: Planes of the first searches: perpendicular ones over half a turn, and angles and tilts of others.
PLANES, ANGLES, TILTS = 60, 36, 10

#: Searches that follow, within one interval of the search before, with half of it: angles are found to 2e-5 radians.
REFINEMENTS = 12

#: A tilted plane is critical if its value is larger than that of any perpendicular plane by this fraction, not by round-off.
MARGIN = 1.0e-6

#: Points may be outside the smallest sphere by this fraction of its radius, and those that determine it farther from its surface by no
#: more than the second: round-off must not exchange them for ever.
SPHERE_TOLERANCE, ON_SPHERE = 1.0e-9, 1.0e-11


class Peak(NamedTuple):
    """The largest value of a parameter, where it is, and angle and tilt of its plane (NaN for a parameter without)."""

    value: float
    x: float
    y: float
    angle: float
    tilt: float


@dataclass(frozen=True)
class ParameterMap:
    """A fatigue parameter at points: `values`, `angle` and `tilt` have the shape of `x` and `y`.

    `angle`: of the normal of the critical plane, projected into the plane of the model, from the x axis, in radians, above -pi/2 and at most
    pi/2; the angle of a crack on this plane from the normal of a flat surface, counterclockwise. `tilt`: of the normal out of the plane of
    the model, from 0 to pi/2; of two mirror images either. NaN for parameters that are invariants. `units`: names of those of lengths
    and of the values.
    """

    name: str
    x: Array
    y: Array
    values: Array
    angle: Array
    tilt: Array | float = 0.0
    units: tuple[str, str] = ("", "")

    @property
    def maximum(self) -> Peak:
        """The largest value with its place and plane; points outside the body do not count. Raises ValueError without a number."""
        if not np.isfinite(self.values).any():
            raise ValueError(f"{self.name} has no value at any point: are the points inside the body?")
        place = np.unravel_index(np.nanargmax(self.values), self.values.shape)
        tilt = np.broadcast_to(self.tilt, self.values.shape)[place]
        return Peak(float(self.values[place]), float(self.x[place]), float(self.y[place]), float(self.angle[place]), float(tilt))


def smith_watson_topper(cycle: StressCycle) -> ParameterMap:
    """sigma_n,max * (normal strain amplitude) on the plane where the product is largest [force/length^2]; 0 where no plane is in tension.

    Smith, Watson, Topper (1970), J. Materials 5, 767; on planes: Socie (1987), ASME J. Engineering Materials 109, 293. Elastic strains.
    """

    def value(normal: Array, _shear: Array) -> Array:
        return np.asarray(np.maximum(np.max(normal, axis=0), 0.0) * 0.5 * np.ptp(normal_strain(cycle, normal), axis=0))

    return _critical_plane("Smith-Watson-Topper", cycle, value, cycle.units)


def fatemi_socie(cycle: StressCycle, *, yield_strength: float, k: float = 1.0) -> ParameterMap:
    """(Shear strain amplitude) * (1 + k sigma_n,max/yield_strength) on the plane where it is largest; compression counts as 0.

    The amplitude is half the range of the engineering shear strain. Fatemi and Socie (1988), Fatigue Fract. Engng Materials Struct. 11, 149.
    """

    def value(normal: Array, shear: Array) -> Array:
        tension = np.maximum(np.max(normal, axis=0), 0.0)
        return np.asarray(_shear_amplitude(shear) / cycle.shear_modulus * (1.0 + k * tension / yield_strength))

    return _critical_plane("Fatemi-Socie", cycle, value, (cycle.units[0], "1"))


def findley(cycle: StressCycle, *, k: float) -> ParameterMap:
    """(Shear stress amplitude) + k sigma_n,max on the plane where the sum is largest [force/length^2]. Findley (1959), J. Eng. Ind. 81, 301."""

    def value(normal: Array, shear: Array) -> Array:
        return np.asarray(_shear_amplitude(shear) + k * np.max(normal, axis=0))

    return _critical_plane("Findley", cycle, value, cycle.units)


def crossland(cycle: StressCycle, *, k: float) -> ParameterMap:
    """sqrt(J2) of the amplitude + k (largest hydrostatic stress) [force/length^2].

    The amplitude is the radius of the smallest sphere around the path of the deviator. Crossland (1956), Int. Conf. Fatigue of Metals,
    138; of paths: Papadopoulos et al. (1997), Int. J. Fatigue 19, 219.
    """
    path = _deviator(cycle)
    centre = _sphere_centre(path)
    amplitude = np.sqrt(0.5 * np.max(np.sum((path - centre) ** 2, axis=-1), axis=0))
    return _invariant("Crossland", cycle, amplitude + k * np.max(cycle.hydrostatic, axis=0))


def dang_van(cycle: StressCycle, *, k: float) -> ParameterMap:
    """Largest of (mesoscopic Tresca shear) + k (hydrostatic stress) over the cycle [force/length^2].

    The mesoscopic stress deviates from the centre of the smallest sphere around the path of the deviator (elastic shakedown). Dang Van
    (1993), ASTM STP 1191, 120.
    """
    path = _deviator(cycle)
    shear = _tresca_shear(path - _sphere_centre(path))
    return _invariant("Dang Van", cycle, np.max(shear + k * cycle.hydrostatic, axis=0))


@dataclass(frozen=True)
class Ruiz:
    """Ruiz's parameters at the nodes over a cycle. `shear`: the largest absolute shear traction; `slip`: the range of the relative slip
    while the surfaces touch, 0 at nodes that do not; `tension`: the largest tension along the surface (0 in compression). `units`: those of
    `first` and `second`."""

    x: Array
    shear: Array
    slip: Array
    tension: Array
    units: tuple[str, str] = ("force/length", "force^2/length^3")

    @property
    def first(self) -> Array:
        """tau delta [force/length]: wear damage."""
        return self.shear * self.slip

    @property
    def second(self) -> Array:
        """sigma tau delta [force^2/length^3]: cracks."""
        return self.tension * self.first


def ruiz(result: Result, *, body: str = "lower", states: Sequence[int] | None = None) -> Ruiz:
    """Ruiz's parameters of a result over its last cycle, at the nodes; arguments and errors as of `stress_cycle`. Raises ValueError
    without friction.

    Ruiz, Boddington, Chen (1984), Exp. Mech. 24, 208; Nowell and Hills (1990), Wear 136, 329.
    """
    if result.attributes["friction_law"] == "none":
        raise ValueError("Ruiz's parameters need friction: without a &friction law there is neither shear nor slip")
    warn_of_doubt(result, "largest_slip_range")
    numbers = last_cycle(result) if states is None else tuple(states)
    history = [kept_states(result).at(number) for number in numbers]
    x, y, slope = surface_nodes(result, body)
    along = normal_stress(stress_cycle(result, x, y, body=body, states=numbers), slope)
    tension = np.maximum(np.max(along, axis=0), 0.0)
    touching = np.array([state.status != NodeStatus.OPEN for state in history])
    slips = np.array([state.slip for state in history])
    slip = np.max(slips, axis=0, where=touching, initial=-np.inf) - np.min(slips, axis=0, where=touching, initial=np.inf)
    shears = np.array([state.shear for state in history])
    length, force = (result.attributes[f"{of}_unit"] for of in ("length", "force"))
    units = f"{force}/{length}", f"{force}^2/{length}^3"
    return Ruiz(np.asarray(result.mesh.x), np.max(np.abs(shears), axis=0), np.maximum(slip, 0.0), tension, units)


def crossland_constant(bending_limit: float, torsion_limit: float) -> float:
    """k of Crossland from the fatigue limits (amplitudes) in fully reversed bending or tension and in torsion."""
    return float(3.0 * (torsion_limit / bending_limit - 1.0 / np.sqrt(3.0)))


def dang_van_constant(bending_limit: float, torsion_limit: float) -> float:
    """k of Dang Van from the fatigue limits (amplitudes) in fully reversed bending or tension and in torsion."""
    return 3.0 * (torsion_limit / bending_limit - 0.5)


def findley_constant(bending_limit: float, torsion_limit: float) -> float:
    """k of Findley from the fatigue limits (amplitudes) in fully reversed bending or tension and in torsion.

    It solves torsion_limit * sqrt(1 + k^2) = bending_limit/2 * (k + sqrt(1 + k^2)). Raises ValueError unless their ratio, torsion over
    bending, is at least 1/2 and less than 1.
    """
    ratio = 2.0 * torsion_limit / bending_limit - 1.0
    if not 0.0 <= ratio < 1.0:
        raise ValueError(
            f"the torsion limit must be at least half the bending limit and less than it, not {torsion_limit / bending_limit} of it"
        )
    return float(ratio / np.sqrt(1.0 - ratio**2))


def _critical_plane(name: str, cycle: StressCycle, value: Callable[[Array, Array], Array], units: tuple[str, str]) -> ParameterMap:
    """The largest value over all planes; `value` has it for the histories of `on_planes`, one plane per point."""

    def at(angle: Array, tilt: Array) -> Array:
        return value(*on_planes(cycle, angle, tilt))

    best, angle, tilt = _largest(at, cycle.x.shape, PLANES, 1)
    tilted = _largest(at, cycle.x.shape, ANGLES, TILTS)
    is_outside = np.isnan(cycle.stress).any(axis=(0, -1))
    is_tilted = tilted[0] * (1.0 - MARGIN * np.sign(tilted[0])) > best  # also where both are -inf outside
    best, angle, tilt = (np.where(is_tilted, *both) for both in zip(tilted, (best, angle, tilt)))
    best, angle, tilt = (np.where(is_outside, np.nan, one) for one in (best, *in_range(angle, tilt)))
    return ParameterMap(name, cycle.x, cycle.y, best, angle, tilt, units)


def _largest(at: Callable[[Array, Array], Array], shape: tuple[int, ...], angles: int, tilts: int) -> tuple[Array, Array, Array]:
    """The largest values of a function of angle and tilt at points, and both. `angles`, `tilts`: of the first search, over half and a
    quarter of a turn; one tilt is 0."""
    best, angle, tilt = np.full(shape, -np.inf), np.zeros(shape), np.zeros(shape)
    step, step_up = np.pi / angles, 0.5 * np.pi / max(tilts - 1, 1)
    turns, rises = step * np.arange(angles), step_up * np.arange(tilts)
    for _ in range(REFINEMENTS + 1):
        middle, height = angle.copy(), tilt.copy()
        for turn in turns:
            for rise in rises:
                here = at(middle + turn, height + rise)
                is_better = here > best
                best = np.where(is_better, here, best)
                angle, tilt = np.where(is_better, middle + turn, angle), np.where(is_better, height + rise, tilt)
        step, step_up = 0.5 * step, 0.5 * step_up
        turns = step * np.arange(-2, 3)
        rises = step_up * np.arange(-2, 3) if tilts > 1 else rises
    return best, angle, tilt


def in_range(angle: Array, tilt: Array) -> tuple[Array, Array]:
    """The same planes, or their mirror images, with angles above -pi/2 and at most pi/2 and tilts from 0 to pi/2."""
    tilt = np.mod(tilt, np.pi)
    return np.pi / 2.0 - np.mod(np.pi / 2.0 - angle, np.pi), np.minimum(tilt, np.pi - tilt)


def on_planes(cycle: StressCycle, angle: Array, tilt: Array) -> tuple[Array, Array]:
    """Normal stress, shape (states, *shape), and shear stress, (2, states, *shape), in the plane of the model and across, on planes whose
    normals have this angle and tilt (see ParameterMap)."""
    xx, yy, xy, zz = np.moveaxis(cycle.stress, -1, 0)
    c, s, up, out = np.cos(angle), np.sin(angle), np.cos(tilt), np.sin(tilt)
    across = xx * c**2 + yy * s**2 + 2.0 * xy * s * c
    along = (yy - xx) * s * c + xy * (c**2 - s**2)
    return across * up**2 + zz * out**2, np.stack([along * up, (across - zz) * up * out])


def normal_strain(cycle: StressCycle, normal: Array) -> Array:
    """Elastic strain along the normals of planes with this normal stress, shape (states, *shape)."""
    return np.asarray((normal - cycle.poisson_ratio * (3.0 * cycle.hydrostatic - normal)) / cycle.youngs_modulus)


def _shear_amplitude(shear: Array) -> Array:
    """Half the longest chord of the paths of shear stresses, shape (2, states, *shape)."""
    longest = np.zeros(shear.shape[2:])
    for apart in range(1, shear.shape[1]):
        along, across = shear[:, apart:] - shear[:, :-apart]
        longest = np.maximum(longest, np.max(along * along + across * across, axis=0))
    return np.asarray(0.5 * np.sqrt(longest))


def _invariant(name: str, cycle: StressCycle, values: Array) -> ParameterMap:
    return ParameterMap(name, cycle.x, cycle.y, values, np.full(cycle.x.shape, np.nan), np.nan, cycle.units)


def normal_stress(cycle: StressCycle, angle: Array) -> Array:
    """Normal stress on planes with normals at these angles, shape (states, *shape)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(cycle.stress[..., 0] * c**2 + cycle.stress[..., 1] * s**2 + 2.0 * cycle.stress[..., 2] * s * c)


def _deviator(cycle: StressCycle) -> Array:
    """The deviator as a vector of three components whose square is that of the tensor, s:s = 2 J2; shape (states, *shape, 3)."""
    xx, yy, xy, zz = np.moveaxis(cycle.stress, -1, 0)
    return np.stack([(xx - yy) / np.sqrt(2.0), (2.0 * zz - xx - yy) / np.sqrt(6.0), np.sqrt(2.0) * xy], axis=-1)


def _tresca_shear(deviator: Array) -> Array:
    """Largest shear stress of deviators: half the difference of the largest and the smallest principal stress."""
    zz = np.sqrt(2.0 / 3.0) * deviator[..., 1]
    radius = np.hypot(deviator[..., 0], deviator[..., 2]) / np.sqrt(2.0)
    first, second = -0.5 * zz + radius, -0.5 * zz - radius
    return np.asarray(0.5 * (np.maximum(first, zz) - np.minimum(second, zz)))


def _sphere_centre(path: Array) -> Array:
    """Centres, shape (*shape, 3), of the smallest spheres around the states of paths, shape (states, *shape, 3).

    The farthest state joins those that determine the sphere until none is outside; the sphere of at most five states is the smallest
    through two to four of them that encloses all (Welzl 1991, LNCS 555, 359: such a set determines it). Raises ArithmeticError if a
    state remains outside.
    """
    points = np.moveaxis(path, 0, -2).reshape(-1, len(path), 3)
    # Relative to a state: the sphere of a small path far from zero stress is exact too.
    origin = points[:, 0].copy()
    points = points - origin[:, None]
    centre = 0.5 * points[:, 1]
    chosen = np.zeros((len(points), 4), dtype=int)
    chosen[:, 1:] = 1
    active = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    for _ in range(10 * len(path)):
        here, rows = points[active], np.arange(active.size)
        distance = np.linalg.norm(here - centre[active, None], axis=2)
        radius = distance[rows[:, None], chosen[active]].max(axis=1)
        farthest = distance.argmax(axis=1)
        is_outside = distance[rows, farthest] > radius * (1.0 + SPHERE_TOLERANCE)
        active, here = active[is_outside], here[is_outside]
        if not active.size:
            return np.asarray((origin + centre).reshape(path.shape[1:]))
        five = np.column_stack([chosen[active], farthest[is_outside]])
        candidates = here[np.arange(active.size)[:, None], five]
        smallest = np.full(active.size, np.inf)
        for size in (2, 3, 4):
            for members in combinations(range(5), size):
                trial = _circumcentre(candidates[:, members])
                away = np.linalg.norm(candidates - trial[:, None], axis=2)
                around = away.max(axis=1)
                # The members themselves must be on this sphere: another set may have the same centre, but not the radius.
                is_smaller = (around < smallest * (1.0 - ON_SPHERE)) & (around <= away[:, members].min(axis=1) * (1.0 + ON_SPHERE))
                smallest = np.where(is_smaller, around, smallest)
                centre[active[is_smaller]] = trial[is_smaller]
                padded = (*members, *members[:1] * (4 - size))
                chosen[active[is_smaller]] = five[is_smaller][:, padded]
    raise ArithmeticError(f"no smallest sphere around the path of the deviator found at {active.size} points")


def _circumcentre(points: Array) -> Array:
    """Points at the same distance of all members of sets, in the plane or line through them; shapes (sets, members, 3), (sets, 3)."""
    edges = points[:, 1:] - points[:, :1]
    squares = 0.5 * np.sum(edges**2, axis=2)
    return np.asarray(points[:, 0] + np.einsum("sij,sj->si", np.linalg.pinv(edges), squares))
