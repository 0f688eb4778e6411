"""Rough surfaces: self-affine ones by SurfaceTopography, their parameters, and what a rough contact looks like.

`self_affine` gives one period of a surface for `Body.profile` and `Mesh(period=)`; `roughness` its parameters; `contact` the length of
contact, its patches and the part of it that sticks in every state of a result, `figure` a picture of these; `mean_and_bar` the mean
over realisations with its confidence interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._packages import needed
from .codes import NodeStatus
from .errors import input_error
from .profiles import Profile
from .result import Group, Result, doubt

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


class Roughness(NamedTuple):
    """Root mean squares over a profile: of the height [length], the slope, and the curvature [1/length]."""

    height: float
    slope: float
    curvature: float


@dataclass(frozen=True)
class RoughContact:
    """What a result says of a rough contact in each of its states (`result.steps`), arrays of shape (states).

    `contact_length` [length] and `patches` count consecutive nodes in contact, up to the edges between nodes; `stick_fraction`: of the
    contact length; NaN without contact, and in steps without friction. `mean_pressure`: force over the contact length; `largest_pressure`: of the nodes
    [force/length^2].
    """

    step: NDArray[np.int64]
    normal_force: Array
    tangential_force: Array
    contact_length: Array
    patches: NDArray[np.int64]
    stick_fraction: Array
    mean_pressure: Array
    largest_pressure: Array
    dissipation: Array
    #: Those of the columns that the mesh does not resolve, as known of the last state.
    unresolved: tuple[str, ...] = ()


#: Observables by which columns of RoughContact are known, if they have other names.
OBSERVABLES = {"stick_fraction": "stick_ratio", "mean_pressure": "contact_length", "largest_pressure": "peak_pressure"}


def self_affine(
    points: int,
    length: float,
    *,
    hurst: float,
    seed: int,
    rms_height: float | None = None,
    rms_slope: float | None = None,
    roll_off: float | None = None,
    cut_off: float | None = None,
    unit: str = "mm",
) -> Profile:
    """One period of a random self-affine profile with a Gaussian distribution of heights, by SurfaceTopography.

    `points` on a period `length`; the profile has one more, which closes it, from -length/2 to length/2. The power spectrum falls with
    the wave number as q^(-1 - 2 hurst) from waves of the length `roll_off` (if omitted: the period), below which it is constant, to
    those of the length `cut_off` (if omitted: two points), beyond which it vanishes. `rms_height` [length] or `rms_slope` is that of
    the spectrum; a realisation differs from it. The same `seed` gives the same profile, also with more points if `cut_off` is given.
    `unit`: of all lengths; the profile is the recess (`Body.profile`). Raises InputError, ModuleNotFoundError.
    """
    if (rms_height is None) == (rms_slope is None):
        raise input_error("self_affine: give one of rms_height and rms_slope")
    given = {"rms_height": rms_height, "rms_slope": rms_slope, "length": length, "roll_off": roll_off, "cut_off": cut_off}
    for name, value in given.items():
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise input_error(f"self_affine: {name} must be a number above 0, not {value!r}")
    if not 0.0 < hurst <= 1.0:
        raise input_error(f"self_affine: hurst must be above 0 and at most 1, not {hurst!r}")
    if points < 4:
        raise input_error(f"self_affine: points must be at least 4, not {points!r}")
    spacing = length / points
    if cut_off is not None and cut_off < 2.0 * spacing:
        raise input_error(f"self_affine: cut_off {cut_off:g} is shorter than two of the {points} points: at least {2 * spacing:g}")
    if roll_off is not None and roll_off < (cut_off or 2.0 * spacing):
        raise input_error(f"self_affine: roll_off {roll_off:g} is shorter than cut_off")
    synthesis = needed("SurfaceTopography.Generation").fourier_synthesis
    # The waves that are there, on the fewest points that have them: more points do not change them.
    fewest = points if cut_off is None else min(points, 2 * int(np.ceil(length / cut_off)) + 2)
    scan = synthesis(
        (fewest,),
        (length,),
        hurst=hurst,
        rms_height=rms_height,
        rms_slope=rms_slope,
        short_cutoff=cut_off,
        long_cutoff=roll_off,
        rng=seed,
        unit=unit,
    )
    waves = np.fft.rfft(np.asarray(scan.heights(), dtype=np.float64))
    heights = np.fft.irfft(waves, points) * (points / fewest)
    x = length * (np.arange(points + 1) / points - 0.5)
    recess = heights.max() - heights
    return Profile(x, np.append(recess, recess[0]), unit, [])


def roughness(x: ArrayLike, height: ArrayLike) -> Roughness:
    """Parameters of a profile with points at equal distances, by SurfaceTopography (ISO 21920: Rq, Rdq; Rddq). Raises InputError,
    ModuleNotFoundError."""
    places, heights = np.asarray(x, dtype=np.float64), np.asarray(height, dtype=np.float64)
    if places.ndim != 1 or places.shape != heights.shape or places.size < 4 or not np.isfinite(heights).all():
        raise input_error("roughness: x and height must be lists of the same length, at least 4, of finite numbers")
    steps = np.diff(places)
    if not np.allclose(steps, steps.mean(), rtol=1e-6, atol=0.0):
        raise input_error("roughness: x must be at equal distances")
    line = needed("SurfaceTopography").UniformLineScan(heights, float(steps.mean() * places.size))
    return Roughness(float(line.Rq()), float(line.Rdq()), float(line.Rddq()))


def contact(result: Result) -> RoughContact:
    """The contact in every state of `result.steps`. Raises ValueError for a result without any."""
    if not result.steps:
        raise ValueError(
            "the result has no states in steps: it was written with states='none' in &output, or ended before the first"
        )
    states = result.steps
    lengths = np.array([float(state.contact_length) for state in states])
    forces = np.array([float(state.normal_force) for state in states])
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.where(lengths > 0.0, forces / lengths, np.nan)
    return RoughContact(
        step=np.array([int(state.step) for state in states]),
        normal_force=forces,
        tangential_force=np.array([float(state.tangential_force) for state in states]),
        contact_length=lengths,
        patches=np.array([int(state.patches) for state in states]),
        stick_fraction=np.array([_stick_fraction(state) for state in states]),
        mean_pressure=mean,
        largest_pressure=np.array([float(np.max(state.pressure)) for state in states]),
        dissipation=np.array([float(state.dissipation) for state in states]),
        unresolved=tuple(name for name in RoughContact.__annotations__ if doubt(result, OBSERVABLES.get(name, name))),
    )


def _stick_fraction(state: Group) -> float:
    """Part of the contact length that sticks; NaN without friction."""
    return float(state.stick_ratio) if state.stick_nodes + state.slip_nodes > 0 else np.nan


def pressures(state: Group) -> Array:
    """Pressures of the nodes in contact of a state [force/length^2]."""
    return np.asarray(state.pressure[state.status != NodeStatus.OPEN], dtype=np.float64)


def patch_lengths(state: Group) -> Array:
    """Lengths of the patches of a state between their edges, from left to right. Patches at both ends of a period count as two."""
    edges = np.asarray(state.contact_edge, dtype=np.float64)
    edges = edges[np.isfinite(edges)]
    return edges[1::2] - edges[::2]


def mean_and_bar(values: ArrayLike, confidence: float = 0.95) -> tuple[float, float]:
    """Mean over independent realisations and half the width of its confidence interval (Student's t; NaN for fewer than two values).
    Needs scipy."""
    sample = np.asarray(values, dtype=np.float64).ravel()
    if sample.size < 2:
        return float(sample.mean()) if sample.size else np.nan, np.nan
    factor = needed("scipy.stats").t.ppf(0.5 + 0.5 * confidence, sample.size - 1)
    return float(sample.mean()), float(factor * sample.std(ddof=1) / np.sqrt(sample.size))


def figure(result: Result, step: int | None = None) -> Figure:
    """Pressure and friction limit over the whole surface, a tenth and a hundredth of it around the largest pressure; contact length and
    patches over the normal force of all states; distributions of pressures and patch lengths of one. See `plot.figure`. Needs
    matplotlib."""
    import matplotlib
    from matplotlib.figure import Figure

    from . import drawing

    state = result.at(step)
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(10.8, 6.4), layout="constrained")
        axes = picture.subplots(2, 3)
        for number, ax in enumerate(axes[0]):
            _zoom(result, state, 10.0**-number, ax)
        _growth(result, axes[1, 0])
        _distributions(result, state, axes[1, 1:])
        picture.suptitle(drawing.heading(result, step), fontsize=12, parse_math=False)
        if unresolved := contact(result).unresolved:
            picture.supxlabel(f"not resolved: {', '.join(unresolved)}", fontsize=9, color="0.35")
    return picture


def _zoom(result: Result, state: Group, part: float, ax: Axes) -> None:
    """Tractions over a part of the surface around the largest pressure."""
    x, width = result.mesh.x, float(np.ptp(result.mesh.x)) * part
    middle = float(x[np.argmax(state.pressure)])
    middle = float(np.clip(middle, x[0] + 0.5 * width, x[-1] - 0.5 * width))
    ax.fill_between(x, state.pressure, color="0.8", label="pressure")
    if np.any(state.shear):
        ax.plot(x, state.shear, color="C3", label="shear")
    ax.set_xlim(middle - 0.5 * width, middle + 0.5 * width)
    ax.set_xlabel(f"x [{result.mesh.unit('x')}]")
    if part == 1.0:
        ax.set_ylabel(f"traction [{result.state.unit('pressure')}]")
        ax.legend(loc="upper left", fontsize=8)


def _growth(result: Result, ax: Axes) -> None:
    """Contact length and number of patches over the normal force."""
    states = contact(result)
    order = np.argsort(states.normal_force, kind="stable")
    ax.plot(states.normal_force[order], states.contact_length[order], "o-", markersize=3)
    ax.set_xlabel(f"normal force [{result.summary.unit('normal_force')}]")
    ax.set_ylabel(f"contact length [{result.summary.unit('contact_length')}]")
    other = ax.twinx()
    other.plot(states.normal_force[order], states.patches[order], "s--", color="C1", markersize=3)
    other.set_ylabel("patches", color="C1")


def _distributions(result: Result, state: Group, axes: NDArray[np.object_]) -> None:
    """Histograms of the pressures of nodes and of the lengths of patches."""
    if (of_nodes := pressures(state)).size:
        axes[0].hist(of_nodes, bins=40, density=True, color="0.6")
    axes[0].set_xlabel(f"pressure [{result.state.unit('pressure')}]")
    axes[0].set_ylabel("probability density")
    lengths = patch_lengths(state)
    lengths = lengths[lengths > 0.0]
    if lengths.size:
        bins = np.geomspace(lengths.min() * 0.999, lengths.max() * 1.001, 25)
        axes[1].hist(lengths, bins=bins, color="0.6")
        axes[1].set_xscale("log")
    axes[1].set_xlabel(f"length of a patch [{result.summary.unit('contact_length')}]")
    axes[1].set_ylabel("patches")
