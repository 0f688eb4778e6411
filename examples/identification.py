"""Coefficient of friction and stiffness of the rig from synthetic loops with noise: how often the intervals are right, and what is biased.

    python examples/identification.py [--seeds 100 | --differences | -o PICTURE.png]

A cylinder on a half-plane of the same material (no coupling, Cattaneo and Mindlin's problem), mu = 0.45, in series with a spring.
"""

from __future__ import annotations

import argparse
import dataclasses

import numpy as np

from mfv import Body, Friction, Mesh, Scene, identify
from mfv.identify import Loop, Priors

MU, FORCE, NOISE = 0.45, 100.0, 0.015
TRUTH = {"friction%mu": MU, "rig_stiffness": 1.0e5}  # N/mm per mm
#: Noise alone: a rig without lag, drift and offset.
PRIORS = Priors(lag=0.0, drift=0.0, offset=0.0)
START = {"friction%mu": 0.6, "rig_stiffness": 7.0e4}


def scene(nodes: int = 101) -> Scene:
    """Millimetres and newtons."""
    aluminium = {"youngs_modulus": 70000.0, "poisson_ratio": 0.3}
    return Scene(
        Body.half_plane(**aluminium),
        Body.disk(10.0, **aluminium),
        friction=Friction.coulomb(1.0),
        mesh=Mesh(nodes=nodes, gap="parabolic"),
        coupling="none",
        length_unit="mm",
        force_unit="N",
    )


def partial(ratio: float, *, force_noise: float = 0.0) -> Loop:
    """A planned loop up to `ratio` of the sliding limit; noise of the shift 1.5 % of its amplitude, of the force `force_noise`."""
    largest = ratio * MU * FORCE
    planned = Loop.planned(FORCE, largest, shift_noise=1.0, force_noise=force_noise * largest)
    (exact,) = identify.simulate(scene(), planned, TRUTH)
    return dataclasses.replace(planned, shift_noise=NOISE * float(np.ptp(exact.shift)) / 2.0, name=f"Q = {ratio:g} mu P")


def gross(*, shift_noise: float = 0.0, rows: int = 100) -> Loop:
    """A planned loop into gross sliding with a prescribed shift; noise of the force 1.5 %."""
    return Loop.planned(
        FORCE,
        6.0e-3,
        rows=rows,
        drive="shift",
        force_noise=NOISE * MU * FORCE,
        shift_noise=shift_noise * 6.0e-3,
        name="gross sliding",
    )


def coverage(name: str, loop: Loop, nodes: int, seeds: int) -> None:
    """How many of the intervals contain the truth."""
    fits = [
        identify.fit(scene(nodes), identify.simulate(scene(nodes), loop, TRUTH, seed=seed), START, priors=PRIORS)
        for seed in range(seeds)
    ]
    planned = identify.plan(scene(nodes), loop, TRUTH, priors=PRIORS)
    for parameter, truth in TRUTH.items():
        inside = sum(low <= truth <= high for fit in fits for low, high in [fit.interval(parameter)])
        spread = np.std([np.log(fit.values[parameter]) for fit in fits])
        print(
            f"{name:34} {parameter:14} inside {inside:3} of {seeds}   scatter {spread:.4f}   "
            f"predicted {planned.standard_errors[parameter] / truth:.4f}",
            flush=True,
        )


def read_at_the_largest(loop: Loop) -> Loop:
    """The loop as a plain fit takes it: exact forces, with the largest measured one as the amplitude."""
    force = loop.tangential_force.copy()
    force[[0, -1]], force[np.argmin(force)] = force.max(), -force.max()
    return dataclasses.replace(loop, tangential_force=force, force_noise=0.0)


def plain_and_weighted(ratio: float, seeds: int) -> None:
    """Scatter and bias of mu from partial slip with 1.5 % noise on both columns."""
    planned = partial(ratio, force_noise=NOISE)
    found = {"both columns noisy": [], "largest force as amplitude": []}
    for seed in range(seeds):
        (loop,) = identify.simulate(scene(), planned, TRUTH, seed=seed)
        found["both columns noisy"].append(identify.fit(scene(), loop, START, priors=PRIORS).values["friction%mu"])
        found["largest force as amplitude"].append(
            identify.fit(scene(), read_at_the_largest(loop), START, priors=PRIORS).values["friction%mu"]
        )
    for name, values in found.items():
        low, middle, high = np.quantile(values, [0.05, 0.5, 0.95])
        print(
            f"Q = {ratio:g} mu P, {name:27} median {middle:.3f}   90 % of the fits in {low:.3f} to {high:.3f}   "
            f"at most 0.38: {sum(value <= 0.38 for value in values)} of {seeds}",
            flush=True,
        )


def further_tests() -> None:
    """Relative standard errors that a further test would leave."""
    first = partial(0.2, force_noise=NOISE)
    print("first test: Q = 0.2 mu P, 1.5 % noise on both columns")
    tests = {
        "alone": [],
        "with the same test again": [first],
        "with Q = 0.4 mu P": [partial(0.4, force_noise=NOISE)],
        "with Q = 0.8 mu P": [partial(0.8, force_noise=NOISE)],
        "with gross sliding": [gross(shift_noise=NOISE, rows=200)],
    }
    for name, more in tests.items():
        errors = identify.plan(scene(201), [first, *more], TRUTH, priors=PRIORS).standard_errors
        print(
            f"{name:26} mu to {errors['friction%mu'] / MU:7.2%}   rig stiffness to {errors['rig_stiffness'] / 1e5:6.2%}", flush=True
        )


def closed_form(force: np.ndarray, largest: float, mu: float) -> np.ndarray:
    """The shift along the branch from the largest force, without its linear part (docs/identify.md)."""
    compliance = 2.0 * (1.0 - 0.3**2) / (np.pi * 70000.0)

    def first(tangential: np.ndarray) -> np.ndarray:
        part = tangential / (mu * FORCE)
        return compliance * mu * FORCE * ((1.0 - part) * np.log1p(-part) + part)

    return first(np.array(largest)) - 2.0 * first((largest - force) / 2.0)


def differences() -> None:
    """Errors of the derivative of the shift with respect to ln mu, by central differences of several steps, against the closed form."""
    steps = (1e-6, 1e-3, 0.01, 0.05, 0.1)
    print("relative error of dU/d(ln mu) with half the step", *(f"{step:8g}" for step in steps))
    for ratio in (0.2, 0.4, 0.8):
        loop = Loop.planned(FORCE, ratio * MU * FORCE, rows=100, shift_noise=1.0)
        force, largest = loop.tangential_force[:51], loop.tangential_force[0]
        exact = (closed_form(force, largest, MU * 1.0001) - closed_form(force, largest, MU / 1.0001)) / 2e-4
        exact -= exact.mean()
        for nodes in (101, 201, 401):
            errors = []
            for step in steps:
                ends = [identify.simulate(scene(nodes), loop, {"friction%mu": MU * np.exp(sign * step)})[0] for sign in (1, -1)]
                slope = (ends[0].shift - ends[1].shift)[:51] / (2.0 * step)
                errors.append(np.linalg.norm(slope - slope.mean() - exact) / np.linalg.norm(exact))
            print(f"Q = {ratio:g} mu P, {nodes} nodes".ljust(48), *(f"{error:8.3f}" for error in errors), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100, help="number of sets of noise")
    parser.add_argument("-o", "--output", help="draw the fit of two loops and do nothing else")
    parser.add_argument("--differences", action="store_true", help="errors of derivatives by differences, and nothing else")
    options = parser.parse_args()
    if options.differences:
        differences()
        return
    if options.output:
        loops = identify.simulate(scene(), [partial(0.4, force_noise=NOISE), gross(rows=200)], TRUTH, seed=1)
        identify.fit(scene(), loops, START).figure().savefig(options.output, dpi=100)
        return
    coverage("Q = 0.6 mu P, shift noisy", partial(0.6), 101, options.seeds)
    coverage("Q = 0.6 mu P, both noisy", partial(0.6, force_noise=NOISE), 101, options.seeds)
    coverage("gross sliding, force noisy", gross(), 41, options.seeds)
    coverage("gross sliding, both noisy", gross(shift_noise=NOISE), 41, options.seeds)
    for ratio in (0.2, 0.3, 0.4):
        plain_and_weighted(ratio, options.seeds)
    further_tests()


if __name__ == "__main__":
    main()
