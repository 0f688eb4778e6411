"""Backbone and cycles of a joint from measured loops, or from a ring-down."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._packages import needed
from ..identify import Loop
from ..identify.path import Path, path_of, smooth_extremes
from ..loop_checks import about_direction
from .backbone import Backbone
from .measurement import Cycle, Measurement

Array = NDArray[np.float64]

#: Smallest slip of a slider over the largest amplitude, and the number of sliders that are tried, their slips growing geometrically.
SMALLEST, TRIED = 0.01, 60

#: Turning points on one side that differ by more than this part of the range are not those of one loop.
SPREAD = 0.03

#: Parts of a branch over which differences from the model are averaged.
BINS = 25

#: Corrections of the frequency of harmonic balance to that of the free decay.
CORRECTIONS = 4


class RingDown(NamedTuple):
    """Frequency and damping of a free decay over its amplitude, a row for every period, and their standard errors."""

    amplitude: Array  #: [length]
    frequency: Array  #: cycles per unit of time
    damping: Array  #: ratio: in half a period the amplitude falls by the factor exp(-pi damping)
    frequency_error: Array
    damping_error: Array


def from_loops(loops: Sequence[tuple[ArrayLike, ArrayLike]]) -> Measurement:
    """What models are fitted to and compared with, from measured loops.

    `loops`: displacement [length] and force [force/length] of every test, rows in the order of time, over a cycle or more between two
    levels in a settled state; from any origin. The deformation of the rig must be removed. Noise is averaged; single spikes are not
    used. The backbone is that of springs and sliders, by least squares without negative stiffness (Lawson and Hanson 1974) on the
    branches by Masing's rules; it ends at the largest amplitude, which is the sliding limit if that loop slides.
    Needs scipy. Raises InputError or ValueError.
    """
    if not loops:
        raise ValueError("give at least one loop: a pair of displacement and force")
    records = [
        Loop(np.asarray(force, dtype=float), np.asarray(shift, dtype=float), 1.0, "shift", name=f"loop {number + 1}")
        for number, (shift, force) in enumerate(loops)
    ]
    paths = [path_of(record) for record in records]
    for record, path in zip(records, paths):
        _check_direction(record, path)
    levels = [_levels(record, path) for record, path in zip(records, paths)]
    amplitudes = [0.5 * (upper - lower) for lower, upper in levels]
    slips = max(amplitudes) * np.geomspace(SMALLEST, 1.0, TRIED)
    rows, forces = [], []
    for number, (record, path, amplitude) in enumerate(zip(records, paths, amplitudes)):
        reached, rises = _reached(record, path, levels[number])
        used = ~path.is_spike
        columns = np.where(rises, -1.0, 1.0) * (_sliders(amplitude, slips) - 2.0 * _sliders(reached, slips)).T
        origin = np.zeros((len(records), columns.shape[1]))
        origin[number] = float(np.ptp(record.tangential_force))
        weight = 1.0 / float(np.ptp(record.tangential_force))
        rows.append(weight * np.concatenate([columns, origin, -origin]).T[used])
        forces.append(weight * record.tangential_force[used])
    found = _positive(np.concatenate(rows), np.concatenate(forces))
    stiffness = found[: TRIED + 1]
    origins = (found[TRIED + 1 : TRIED + 1 + len(records)] - found[TRIED + 1 + len(records) :]) * [
        float(np.ptp(record.tangential_force)) for record in records
    ]
    backbone = _backbone(slips, stiffness)
    cycles = [
        _cycle(record, path, ends, float(origin), slips, stiffness)
        for record, path, ends, origin in zip(records, paths, levels, origins)
    ]
    return Measurement(backbone, sorted(cycles, key=lambda cycle: cycle.amplitude))


def ring_down(time: ArrayLike, displacement: ArrayLike) -> RingDown:
    """Frequency and damping of a free decay over its amplitude, from the turning points of a record of the `displacement` over the
    `time`. Raises ValueError.

    A constant origin does not matter: an amplitude is half the way between turning points. Turning points are those of a
    polynomial through the rows around them, up to an amplitude of four standard deviations of the noise.
    """
    at, column = np.asarray(time, dtype=float), np.asarray(displacement, dtype=float)
    if at.ndim != 1 or at.shape != column.shape or at.size < 20 or not (np.isfinite(at).all() and np.isfinite(column).all()):
        raise ValueError("a ring-down needs two columns of at least 20 finite numbers, time and displacement")
    if np.any(np.diff(at) <= 0.0):
        raise ValueError("the times of a ring-down must increase")
    found = smooth_extremes(column, at)
    if len(found) < 4:
        raise ValueError(f"the record has {len(found)} turning points; a ring-down needs at least 4")
    value, error, when, when_error = (np.array(each) for each in zip(*found))
    half = 0.5 * np.abs(np.diff(value))
    period = when[2:] - when[:-2]
    # The turning point in the middle of a period changes both halves alike.
    return RingDown(
        np.sqrt(half[1:] * half[:-1]),
        1.0 / period,
        np.log(half[:-1] / half[1:]) / np.pi,
        np.hypot(when_error[2:], when_error[:-2]) / period**2,
        0.5 * np.hypot(error[2:] / half[1:], error[:-2] / half[:-1]) / np.pi,
    )


def from_ring_down(decay: RingDown, mass: float) -> Measurement:
    """What models are fitted to and compared with, from the frequency and the damping of a `mass` [force time^2/length^2, that of one
    degree of freedom] on the joint alone.

    By Masing's rules the work between turning points u_n and u_(n+1) vanishes if 2 B(A_n) = 2 W(A_n)/A_n + 2 W(A_(n+1))/A_(n+1) with
    the amplitudes A, the backbone B and its integral W, which is linear in the stiffness of sliders, as is the stiffness of harmonic
    balance, corrected to the period of the decay. Least squares without negative stiffness. The backbone ends at the largest amplitude.
    Needs scipy. Raises ValueError.
    """
    columns = [np.asarray(column, dtype=float) for column in decay]
    amplitude, frequency, damping, frequency_error, damping_error = columns
    is_wrong = any(column.shape != amplitude.shape or not np.isfinite(column).all() for column in columns)
    if is_wrong or amplitude.size < 2 or np.any(amplitude <= 0.0) or np.any(frequency <= 0.0):
        raise ValueError("a ring-down needs columns of equal length, at least 2, amplitudes and frequencies above 0")
    if not 0.0 < mass < np.inf:
        raise ValueError(f"mass={mass}: must be a positive number")
    ratio = np.exp(0.5 * np.pi * damping)
    slips = float((amplitude * ratio).max()) * np.geomspace(SMALLEST, 1.0, TRIED)
    before, after = amplitude * ratio, amplitude / ratio
    work = _sliders(before, slips) - _works(before, slips) / before[:, None] - _works(after, slips) / after[:, None]
    balance = _balance(amplitude, slips)
    measured = mass * (2.0 * np.pi * frequency) ** 2
    by_frequency = 1.0 / np.maximum(2.0 * frequency_error / frequency, 1e-4)
    # The work changes with the damping by pi/2 of stiffness times amplitude.
    by_damping = 1.0 / np.maximum(0.5 * np.pi * damping_error, 1e-5)
    correction = np.ones(amplitude.size)
    for _ in range(CORRECTIONS):
        target = measured * correction
        weight = (by_damping / (measured * amplitude))[:, None]
        rows = np.concatenate([balance * (by_frequency / measured)[:, None], work * weight])
        stiffness = _positive(rows, np.concatenate([target * by_frequency / measured, np.zeros(amplitude.size)]))
        period = _period(amplitude, slips, stiffness, mass)
        correction = (balance @ stiffness) * (period / (2.0 * np.pi)) ** 2 / mass
    backbone = _backbone(slips, stiffness)
    order = np.argsort(amplitude)
    force = _sliders(amplitude, slips) @ stiffness
    lost = 2.0 * np.pi * damping * measured * amplitude**2
    cycles = [
        Cycle(np.array([u, -u, u]), np.array([q, -q, q]), float(energy))
        for u, q, energy in zip(amplitude[order], force[order], lost[order])
    ]
    return Measurement(backbone, cycles)


def _check_direction(record: Loop, path: Path) -> None:
    """Raises ValueError for a loop that no springs and sliders have, since the force has the other sign or the rows another order."""
    force, shift = record.tangential_force, record.shift
    if np.ptp(force) == 0.0:
        raise ValueError(f"{record.name}: the force does not change")
    if record.is_reversed:
        raise ValueError(f"{record.name}: the force falls where the displacement grows; change the sign of one of them")
    turns = np.flatnonzero(np.diff(path.branch)).tolist()
    for sentence in about_direction(record.name, force, shift, turns, path.noise):
        raise ValueError(sentence)


def _levels(record: Loop, path: Path) -> tuple[float, float]:
    """Lower and upper turning point of a settled loop. Raises ValueError."""
    turns = path.levels[path.turns[:-1]]
    if turns.size < 1:
        raise ValueError(f"{record.name}: does not turn; needs a cycle or more between two levels")
    middle = 0.5 * float(path.levels.max() + path.levels.min())
    # The record may end or begin within a branch; with one turn inside, the other level is at an end.
    levels = turns if turns.size > 1 else path.levels
    sides = [levels[levels < middle], levels[levels > middle]]
    if any(np.ptp(side) > SPREAD * np.ptp(path.levels) for side in sides):
        raise ValueError(f"{record.name}: does not go to and fro between two levels; give a pair for every amplitude")
    return float(sides[0].mean()), float(sides[1].mean())


def _reached(record: Loop, path: Path, levels: tuple[float, float]) -> tuple[Array, NDArray[np.bool_]]:
    """Of every row half its way from the last turning point, and whether its branch rises."""
    begins_upward = path.levels[path.turns[0]] > 0.5 * (levels[0] + levels[1])
    upward = (path.branch % 2 == 0) == begins_upward
    way = np.where(upward, record.shift - levels[0], levels[1] - record.shift)
    return 0.5 * np.maximum(way, 0.0), upward


def _sliders(displacement: ArrayLike, slips: Array) -> Array:
    """Forces of first loading of sliders of unit stiffness and, last, of a spring without one."""
    u = np.asarray(displacement, dtype=float)[..., None]
    return np.concatenate([np.minimum(u, slips), u], axis=-1)


def _works(displacement: Array, slips: Array) -> Array:
    """Integrals of the forces of `_sliders`."""
    u = displacement[:, None]
    reached = np.minimum(u, slips)
    return np.concatenate([slips * u - 0.5 * slips**2 + 0.5 * (slips - reached) ** 2, 0.5 * u**2], axis=1)


def _balance(amplitude: Array, slips: Array) -> Array:
    """Stiffness of a slider of unit stiffness by harmonic balance, (theta - sin theta cos theta)/pi with cos theta = 1 - 2 phi/A."""
    theta = np.arccos(np.clip(1.0 - 2.0 * slips / amplitude[:, None], -1.0, 1.0))
    return np.concatenate([(theta - np.sin(theta) * np.cos(theta)) / np.pi, np.ones((amplitude.size, 1))], axis=1)


def _period(amplitude: Array, slips: Array, stiffness: Array, mass: float, points: int = 200) -> Array:
    """Period of a free decay: twice the time from a turning point at a distance of twice the amplitude from the next.

    The speed follows from the work, which vanishes at both; the time is a sum over angles theta with u = A cos theta.
    """
    angle = (np.arange(points) + 0.5) * np.pi / points
    way = amplitude[:, None] * (1.0 - np.cos(angle))
    whole = _works(amplitude, slips) @ stiffness
    begins = 2.0 * whole / amplitude
    done = np.stack([_works(0.5 * each, slips) @ stiffness for each in way.T], axis=1)
    work = begins[:, None] * way - 4.0 * done
    return np.asarray(2.0 * np.pi / points * np.sum(amplitude[:, None] * np.sin(angle) / np.sqrt(2.0 * work / mass), axis=1))


def _positive(rows: Array, values: Array) -> Array:
    """Least squares with unknowns of at least 0, columns scaled."""
    norms = np.linalg.norm(rows, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    found, _ = needed("scipy.optimize").nnls(rows / scale, values, maxiter=100 * rows.shape[1])
    return np.asarray(found / scale)


def _backbone(slips: Array, stiffness: Array) -> Backbone:
    """The backbone of sliders up to the largest slip."""
    at = np.append(0.0, slips)
    return Backbone.of(at, np.maximum.accumulate(_sliders(at, slips) @ stiffness))


def _cycle(record: Loop, path: Path, levels: tuple[float, float], origin: float, slips: Array, stiffness: Array) -> Cycle:
    """The mean cycle of a record: that of the sliders, and the mean differences from it."""
    reached, rises = _reached(record, path, levels)
    amplitude = 0.5 * (levels[1] - levels[0])
    top = float(_sliders(amplitude, slips) @ stiffness)
    way = np.linspace(0.0, amplitude, 4 * BINS + 1)
    branch = top - 2.0 * (_sliders(way, slips) @ stiffness)
    sides = []
    for side, sign in ((~rises, 1.0), (rises, -1.0)):
        rows = side & ~path.is_spike
        model = sign * (top - 2.0 * (_sliders(reached[rows], slips) @ stiffness))
        place = np.clip((reached[rows] / amplitude * BINS).astype(int), 0, BINS - 1)
        count = np.bincount(place, minlength=BINS)
        total = np.bincount(place, weights=record.tangential_force[rows] - origin - model, minlength=BINS)
        mean = np.divide(total, count, out=np.zeros(BINS), where=count > 0)
        sides.append(sign * branch + np.interp(way, (np.arange(BINS) + 0.5) * amplitude / BINS, mean))
    falling, rising = sides
    ends = 0.5 * (falling[0] + rising[-1]), 0.5 * (falling[-1] + rising[0])
    falling[[0, -1]], rising[[0, -1]] = ends, ends[::-1]
    shift = np.concatenate([amplitude - 2.0 * way, -amplitude + 2.0 * way[1:]])
    force = np.concatenate([falling, rising[1:]])
    return Cycle(shift, force, float(0.5 * (force[1:] + force[:-1]) @ np.diff(shift)))
