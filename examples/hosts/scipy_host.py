"""A frictional contact inside programs of scipy: statics by root-finding, dynamics by an integrator of ordinary differential equations.

    python examples/hosts/scipy_host.py -o scipy_host.png

A contact depends on its history, and a solver tries motions that it rejects. Every trial therefore begins at the same saved state:
`restore` restores it bit-identically, and only an accepted state is saved with `save`.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult, root

import mfv

#: Forces per unit thickness, relative to the shear modulus times a length: normal force that presses every contact.
WEIGHT = 1.0e-3


def contact(mu: float) -> mfv.Case:
    """A rigid cylinder on a half-plane, pressed by WEIGHT without friction.

    Goodman's coupling: shear does not change the pressure, as in the closed forms that the tests compare with. No history is recorded,
    so that states can be restored in any order.
    """
    case = mfv.Scene(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
        mfv.Body.disk(0.25, rigid=True),
        mesh=mfv.Mesh(nodes=101, half_width=0.0127),
        friction=mfv.Friction.coulomb(mu),
        coupling="goodman",
        output=mfv.Output(history="none", states="none"),
    ).contact()
    case.advance(normal_force=WEIGHT, friction=False, check=True)
    return case


# --- statics: two contacts in series ---


@dataclass
class Series:
    """Two contacts, one on top of the other, a plate between them; both are loaded by WEIGHT. The top is shifted, the bottom is fixed.

    Unknowns: the approaches of both contacts and the shift of the plate, [a1, a2, s]; the upper contact then has the shift
    top - s. Equilibrium: P1 = P2 = WEIGHT, Q1 = Q2.
    """

    lower: mfv.Case
    upper: mfv.Case
    with_tangent: bool = True
    evaluations: int = 0
    #: The present trial of the contacts, with its shift of the top.
    led: NDArray[np.float64] = field(init=False)
    states: list[mfv.State] = field(init=False)
    unknowns: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        self.states = [self.lower.save(), self.upper.save()]
        self.unknowns = np.array([self.lower.loads.approach, self.upper.loads.approach, 0.0])
        self.led = np.append(self.unknowns, 0.0)

    def lead(self, unknowns: NDArray[np.float64], top: float) -> None:
        """Advance both contacts from their saved states to a trial, unless they are there."""
        if np.array_equal(self.led, np.append(unknowns, top)):
            return
        lower_approach, upper_approach, plate = unknowns
        for case, state, approach, shift in (
            (self.lower, self.states[0], lower_approach, plate),
            (self.upper, self.states[1], upper_approach, top - plate),
        ):
            case.restore(state)
            case.advance(approach=approach, shift=shift, check=True)
        self.led = np.append(unknowns, top)
        self.evaluations += 1

    def imbalance(self, unknowns: NDArray[np.float64], top: float) -> NDArray[np.float64]:
        """Residual of equilibrium, relative to WEIGHT."""
        self.lead(unknowns, top)
        lower, upper = self.lower.loads, self.upper.loads
        forces = lower.normal_force, upper.normal_force, lower.tangential_force
        return (np.array(forces) - (WEIGHT, WEIGHT, upper.tangential_force)) / WEIGHT

    def jacobian(self, unknowns: NDArray[np.float64], top: float) -> NDArray[np.float64]:
        """Derivatives of the residual, from the consistent tangents of both contacts, rows (P, Q), columns (a, s)."""
        self.lead(unknowns, top)
        lower, upper = self.lower.tangent(), self.upper.tangent()
        return (
            np.array(
                [
                    [lower[0, 0], 0.0, lower[0, 1]],
                    [0.0, upper[0, 0], -upper[0, 1]],
                    [lower[1, 0], -upper[1, 0], lower[1, 1] + upper[1, 1]],
                ]
            )
            / WEIGHT
        )

    def shift_top(self, top: float) -> float:
        """Find the equilibrium for a shift of the top and save it; return the tangential force.

        Raises RuntimeError if it is not found; the joint is then unchanged.
        """
        derivatives = self.jacobian if self.with_tangent else None
        found: OptimizeResult = root(self.imbalance, self.unknowns, args=(top,), jac=derivatives, tol=1e-6)
        if not found.success:
            raise RuntimeError(f"no equilibrium at the shift {top:.6g}: {found.message}")
        self.lead(found.x, top)  # the last trial may be another one
        self.states = [case.save(state) for case, state in zip((self.lower, self.upper), self.states)]
        self.unknowns = found.x
        return self.lower.loads.tangential_force


# --- dynamics: a mass on a contact ---


@dataclass
class RingDown:
    """Motion of a mass after its release."""

    time: NDArray[np.float64]
    shift: NDArray[np.float64]
    #: Tangential forces at the turning points, the first one at the release, and the energy dissipated so far.
    forces: NDArray[np.float64]
    dissipation: NDArray[np.float64]


def ring_down(case: mfv.Case, force: float, mass: float, half_cycles: int) -> RingDown:
    """Load a mass on a contact by a tangential force, release it, and follow its motion; only friction damps it.

    m x'' = -Q(x), where Q depends on the load history. Between two turning points x is monotonic, so the contact advances there
    in one step with all events. solve_ivp therefore integrates from one turning point to the next (an event ends it at zero
    velocity), and every evaluation begins at the contact's state at the last turning point, independent of other evaluations.
    """
    case.advance(tangential_force=force, check=True)
    turns = [case.loads]
    times, shifts = [np.zeros(1)], [np.array([case.loads.shift])]
    state = case.save()

    def rates(_: float, motion: NDArray[np.float64]) -> tuple[float, float]:
        case.restore(state)
        case.advance(shift=motion[0], check=True)
        return motion[1], -case.loads.tangential_force / mass

    def velocity(_: float, motion: NDArray[np.float64]) -> float:
        return float(motion[1])

    velocity.terminal = True  # type: ignore[attr-defined]
    for _ in range(half_cycles):
        # At the start it is also at rest, but there the velocity leaves zero in the other direction.
        velocity.direction = np.sign(turns[-1].tangential_force)  # type: ignore[attr-defined]
        start, long_enough = (
            times[-1][-1],
            10.0 * np.pi * np.sqrt(mass * abs(turns[-1].shift / turns[-1].tangential_force)),
        )
        way = solve_ivp(
            rates,
            (start, start + long_enough),
            (shifts[-1][-1], 0.0),
            events=velocity,
            rtol=1e-6,
            atol=1e-6 * abs(shifts[0][0]),
            max_step=0.01 * long_enough,
        )
        if not way.t_events[0].size:
            raise RuntimeError(f"no turning point: {way.message}")
        times.append(way.t[1:])
        shifts.append(way.y[0, 1:])
        case.restore(state)
        case.advance(shift=way.y[0, -1], check=True)
        state = case.save(state)
        turns.append(case.loads)
    return RingDown(
        np.concatenate(times),
        np.concatenate(shifts),
        np.array([turn.tangential_force for turn in turns]),
        np.array([turn.dissipation for turn in turns]),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description="a frictional contact in programs of scipy")
    parser.add_argument("-o", "--output", help="picture to draw")
    options = parser.parse_args()

    tops = np.concatenate((np.linspace(0.0, 8.0e-4, 9)[1:], np.linspace(8.0e-4, -8.0e-4, 17)[1:]))
    forces = []
    for with_tangent in (True, False):
        series = Series(contact(0.5), contact(0.7), with_tangent)
        forces = [series.shift_top(top) for top in tops]
        words = "with the tangent" if with_tangent else "with differences"
        print(f"two contacts in series, {words}: {series.evaluations / len(tops):.1f} evaluations an equilibrium")

    free = ring_down(contact(0.5), 0.8 * 0.5 * WEIGHT, 1.0, 12)
    print("a mass released at Q = 0.8 mu P turns at Q/(mu P) =", np.round(free.forces / (0.5 * WEIGHT), 3))
    if options.output:
        draw(tops, np.array(forces), free, options.output)


def draw(tops: NDArray[np.float64], forces: NDArray[np.float64], free: RingDown, path: str) -> None:
    """The loop of the two contacts and the motion of the mass."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(8.4, 3.6), layout="constrained")
    left, right = picture.subplots(1, 2)
    left.plot(np.append(0.0, tops), np.append(0.0, forces) / WEIGHT, "o-", markersize=3.5, linewidth=1.0)
    left.set(xlabel="shift of the top", ylabel="tangential force over the weight", title="Two contacts in series (root)")
    right.plot(free.time, free.shift, linewidth=1.0)
    right.set(xlabel="time", ylabel="shift of the mass", title="A mass braked by friction (solve_ivp)")
    for ax in (left, right):
        ax.axhline(0.0, color="0.7", linewidth=0.6, zorder=0)
        ax.ticklabel_format(scilimits=(-3, 4))
    picture.savefig(path, dpi=180)


if __name__ == "__main__":
    main()
