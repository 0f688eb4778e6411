"""Signs of a wrong unit, sign or column in measured loops of tangential force over shift, before anything is fitted to them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: A loop cannot be stiffer than this times the contact, since a rig in series makes it softer; the arbitrary datum of
#: two-dimensional elasticity changes the stiffness of the contact by less.
_TOO_STIFF = 2.0

#: A loop softer than this times contact and rig is unlikely.
_TOO_SOFT = 1.0 / 30.0

#: No pair of surfaces is known to have a larger coefficient of friction in fretting.
_LARGEST_RATIO = 3.0


def doubts_about(
    name: str,
    force: Array,
    shift: Array,
    normal_force: float,
    turns: Sequence[int],
    noise: tuple[float, float],
    stiffness: tuple[float, float],
) -> list[str]:
    """Sentences about what cannot be in a loop, with the likely cause. `turns`: rows at which the driven column reverses; `noise`:
    standard deviations of force and shift; `stiffness`: tangential stiffness of the contact alone and with the rig in series
    [force/length^2], NaN if unknown."""
    sentences = about_direction(name, force, shift, turns, noise)
    measured = _stiffness(force, shift, turns)
    alone, with_rig = stiffness
    if measured > _TOO_STIFF * alone:
        sentences.append(
            f"{name}: the loop is {measured / alone:.3g} times as stiff as the contact, which a rig can only make softer: forces in N "
            "where the scene has N/mm (give the thickness), or a shift in millimetres where the scene has micrometres (units)"
        )
    elif abs(measured) < _TOO_SOFT * with_rig:
        sentences.append(
            f"{name}: the loop has {measured / with_rig:.2g} of the stiffness of contact and rig: a shift in micrometres where the scene "
            "has millimetres (units={'shift': 'um'}), forces in kN where it has N, or a rig that is softer than its start value"
        )
    ratio = float(np.max(np.abs(force)) / normal_force)
    if ratio > _LARGEST_RATIO:
        sentences.append(
            f"{name}: the tangential force reaches {ratio:.3g} times the normal force: their units differ, or the thickness divides one "
            "of them only"
        )
    return sentences


def about_direction(name: str, force: Array, shift: Array, turns: Sequence[int], noise: tuple[float, float]) -> list[str]:
    """The sentence about a loop in which friction would do negative work, if it does; arguments as in `doubts_about`."""
    if not _runs_backwards(force, shift, turns, noise):
        return []
    return [
        f"{name}: the loop runs the wrong way round, friction would do negative work: force and shift are exchanged, the rows are "
        "in reverse order, or the shift was measured before the force"
    ]


def _runs_backwards(force: Array, shift: Array, turns: Sequence[int], noise: tuple[float, float]) -> bool:
    """Whether the work in complete cycles is negative by more than its noise."""
    if len(turns) >= 3:
        rows = slice(turns[0], turns[len(turns) - 1 - (len(turns) - 1) % 2] + 1)
    elif abs(force[-1] - force[0]) < 0.1 * np.ptp(force):
        rows = slice(0, force.size)
    else:
        return False
    q, u = force[rows], shift[rows]
    closed_q, closed_u = np.append(q, q[0]), np.append(u, u[0])
    steps_q, steps_u = np.diff(closed_q), np.diff(closed_u)
    work = float(np.sum(0.5 * (closed_q[1:] + closed_q[:-1]) * steps_u))
    error = noise[1] * np.sqrt(np.sum(steps_q**2)) + noise[0] * np.sqrt(np.sum(steps_u**2))
    return bool(work < -max(4.0 * error, 1e-6 * float(np.ptp(q) * np.ptp(u))))


def _stiffness(force: Array, shift: Array, turns: Sequence[int]) -> float:
    """The stiffness after reversals, or, with too few rows, of the whole loop: change of force over change of shift."""
    reach = 0.3 * np.ptp(force)
    slopes = []
    for first, last in zip(turns, [*turns[1:], force.size - 1]):
        q, u = force[first : last + 1] - force[first], shift[first : last + 1] - shift[first]
        near = np.abs(q) <= reach
        if np.count_nonzero(near) >= 5 and np.ptp(q[near]) > 0.5 * reach:
            slopes.append(float(np.polyfit(q[near], u[near], 1)[0]))
    slope = float(np.median(slopes)) if slopes else float(np.ptp(shift) / np.ptp(force))
    return 1.0 / slope if slope else np.inf
