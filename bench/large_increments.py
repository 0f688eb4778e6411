"""Large increments (stepping='leap') against events: coupled cycles, and random scenes.

    PYTHONPATH=python python bench/large_increments.py cycles 100
    PYTHONPATH=python python bench/large_increments.py random 250 1e-3
    PYTHONPATH=python python bench/large_increments.py held-back 40 1e-3
    PYTHONPATH=python python bench/large_increments.py growing 40 1e-2
    PYTHONPATH=python python bench/large_increments.py nonlinear 24 1e-2
    PYTHONPATH=python python bench/large_increments.py rough 40 1e-2

The first prints, for some tolerances, the linear solves and the largest error of what a cycle dissipates. The second compares
tractions and the dissipation of every load segment in random scenes of Coulomb friction: couplings, materials, disks and a flat
punch, 101 to 401 nodes, pressing with friction, oblique loads, cycles of either force, unloading, prescribed displacements. It
prints the scenes above the tolerance, and how often the estimated errors bound the true ones; the third does so for other scenes of
801 to 1201 nodes, with stepping='auto', for errors above a thousandth of the tolerance. The fourth presses what does not grow in
proportion to its shape with full coupling: layers, waves that repeat, rounded and conforming punches, profiles. The fifth compares
random scenes of Dahl's law and of weakening with much shorter increments. The last presses and shears rough surfaces with full coupling
(needs SurfaceTopography), and prints errors of what users read.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable

import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Output, Scene, Solver, Step

NODES, HELD_BACK_NODES = (101, 161, 241, 401), (801, 1001, 1201)
#: First seed of the scenes that are held back.
HELD_BACK = 1000
#: Relative differences below these are round-off.
ROUND_OFF_TRACTION, ROUND_OFF_DISSIPATION = 1e-9, 1e-9


def cycles_scene(solver: Solver, cycles: int) -> Scene:
    """A rigid disk pressed on a half-plane with friction and full coupling, and sheared back and forth."""
    force = math.pi / 4
    steps = [
        Step(normal_force=force),
        Step(tangential_force=0.24 * force),
        Step(tangential_force=-0.24 * force, cycles=cycles),
    ]
    return Scene(
        Body.half_plane(youngs_modulus=100.0, poisson_ratio=0.0),
        Body.disk(100.0, rigid=True),
        mesh=Mesh(nodes=256, half_width=1.25, gap="parabolic"),
        friction=Friction.coulomb(0.3),
        steps=steps,
        solver=solver,
        output=Output(history="steps", states="none"),
    )


def study_cycles(cycles: int) -> None:
    events = cycles_scene(Solver(stepping="event"), cycles).run()
    exact = np.array(events.cycles.dissipation)
    print(f"events: {events.summary.linear_solves} solves")
    for tolerance in (1e-2, 1e-3, 1e-4):
        result = cycles_scene(Solver(stepping="leap", accuracy=tolerance), cycles).run()
        error = np.array(result.cycles.dissipation) / exact - 1
        shear = np.abs(result.state.shear - events.state.shear).max() / np.abs(events.state.pressure).max()
        print(
            f"accuracy {tolerance:.0e}: {result.summary.linear_solves} solves, {result.summary.leaps} increments, error of "
            f"a cycle {np.abs(error).max():.1e}, of the first {error[0]:.1e}, of the last {error[-1]:.1e}, of the shear {shear:.0e}, "
            f"estimated {result.summary.increment_dissipation_error:.0e} and {result.summary.increment_traction_error:.0e}"
        )


def random_scene(seed: int, solver: Solver) -> Scene:
    """Scene number `seed`, from HELD_BACK on with more nodes; lengths in units of some radius, moduli of the half-plane's shear modulus."""
    draw = np.random.default_rng(seed)
    poisson = float(draw.choice([0.0, 0.1, 0.2, 0.3, 0.4, 0.49]))
    mu = float(10 ** draw.uniform(-1.3, 0.2))
    coupling = str(draw.choice(["full", "full", "goodman", "none"]))
    nodes, radius = int(draw.choice(HELD_BACK_NODES if seed >= HELD_BACK else NODES)), float(10.0 ** draw.integers(-2, 3))
    width, shape = 0.02 * radius, int(draw.integers(0, 5))
    modulus, half_width = 1 / (1 - poisson), 1.25 * width
    if shape == 4:
        upper, half_width = Body.flat_punch(width), width
    elif shape == 3:
        shear_modulus, ratio = float(10 ** draw.uniform(-1, 1)), float(draw.uniform(0, 0.5))
        upper = Body.disk(radius, shear_modulus=shear_modulus, poisson_ratio=ratio)
        modulus = 1 / (1 - poisson + (1 - ratio) / shear_modulus)
    else:
        upper = Body.disk(radius, rigid=True)
    force = 0.01 * modulus * width if shape == 4 else math.pi * modulus * width**2 / (2 * radius)
    return Scene(
        Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson),
        upper,
        mesh=Mesh(nodes=nodes, half_width=half_width),
        friction=Friction.coulomb(mu),
        steps=random_steps(draw, force, mu, force / (math.pi * modulus) * (0.5 + math.log(100))),
        coupling=coupling,
        solver=solver,
        output=Output(history="steps"),
    )


def random_steps(draw: np.random.Generator, force: float, mu: float, approach: float) -> list[Step]:
    """One of seven kinds of load histories up to a normal `force` (an `approach`)."""

    def part(low: float, high: float) -> float:
        return float(draw.uniform(low, high))

    friction, kind = bool(draw.random() < 0.7), int(draw.integers(0, 7))
    limit, sign = mu * force, float(draw.choice([-1, 1]))
    press = Step(normal_force=force, friction=friction)
    part_press = Step(normal_force=part(0.4, 1) * force, friction=friction)
    if kind == 0:
        shear = sign * part(0.1, 0.95) * limit
        back = Step(tangential_force=-shear * part(-0.5, 1), cycles=int(draw.integers(1, 4)))
        return [press, Step(tangential_force=shear), back]
    if kind == 1:
        oblique = Step(normal_force=force, tangential_force=sign * part(0.05, 0.9) * limit)
        return [part_press, oblique, Step(normal_force=part(0.3, 0.9) * force, tangential_force=part(-0.25, 0.25) * limit)]
    if kind == 2:
        shear = part(0.1, 0.5)
        return [press, Step(tangential_force=sign * shear * limit), Step(normal_force=part(1.1 * shear, 1) * force)]
    if kind == 3:
        shift = mu * approach * part(0.05, 0.8)
        return [press, Step(shift=shift), Step(shift=-shift * part(-0.5, 1), cycles=int(draw.integers(1, 3)))]
    if kind == 4:
        cycles = Step(normal_force=part(0.4, 0.8) * force, cycles=int(draw.integers(1, 3)))
        return [part_press, Step(tangential_force=sign * part(0.05, 0.25) * limit), Step(normal_force=force), cycles]
    if kind == 5:
        walk = [part_press]
        for _ in range(int(draw.integers(2, 6))):
            normal = part(0.3, 1) * force
            walk.append(Step(normal_force=normal, tangential_force=part(-0.9, 0.9) * mu * normal))
        return walk
    return [
        Step(approach=part(0.3, 1) * approach, friction=friction),
        Step(shift=part(-0.5, 0.5) * mu * approach),
        Step(approach=part(0.2, 1) * approach, shift=part(-0.5, 0.5) * mu * approach),
    ]


def growing_scene(seed: int, solver: Solver) -> Scene:
    """Scene number `seed` of a contact that does not grow in proportion to its shape, pressed with friction and full coupling."""
    draw = np.random.default_rng(seed)
    poisson, mu = float(draw.choice([0.0, 0.2, 0.3, 0.4])), float(10 ** draw.uniform(-1, 0.2))
    kind, width = int(draw.integers(0, 6)), 1.0
    lower = Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson)
    force = float(draw.uniform(0.3, 1)) * 0.5 * math.pi * width**2 / (2 * 50.0) / (1 - poisson)
    upper, half_width, period = Body.disk(50.0, rigid=True), 1.5 * width, None
    if kind < 2:
        layer = mfv.Layer(
            thickness=float(10 ** draw.uniform(-1, 0.3)), shear_modulus=float(10 ** draw.uniform(-1, 1)), poisson_ratio=0.3
        )
        lower = Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson, layers=[layer])
        force *= min(layer.shear_modulus, 1.0)
    elif kind == 2:
        upper, period, half_width = Body.wave(5e-3, 2.0, rigid=True), 2.0, None
        force = float(draw.uniform(0.2, 0.8)) * math.pi * 5e-3 / (1 - poisson)
    elif kind == 3:
        upper = Body.rounded_punch(float(draw.uniform(0.1, 0.6)), 30.0, rigid=True)
    elif kind == 4:
        upper = Body.power(0.01, float(draw.uniform(1.6, 4)), shear_modulus=float(10 ** draw.uniform(-0.5, 1)), poisson_ratio=0.1)
    else:
        x = np.linspace(-1.5, 1.5, 13)
        upper = Body.profile(x, 0.01 * x**2 + draw.uniform(0, 3e-4, 13), interpolation="monotone_cubic", rigid=True)
    shear = float(draw.choice([0.0, draw.uniform(-0.5, 0.5)])) * mu * force
    steps = [Step(normal_force=force, tangential_force=shear) if shear else Step(normal_force=force)]
    steps.append(Step(tangential_force=float(draw.uniform(-0.7, 0.7)) * mu * force))
    return Scene(
        lower,
        upper,
        mesh=Mesh(nodes=int(draw.choice([801, 1001, 1501])), half_width=half_width, period=period),
        friction=Friction.coulomb(mu),
        steps=steps,
        coupling="full",
        solver=solver,
        output=Output(history="steps"),
    )


def differences(events: mfv.Result, result: mfv.Result, least: float) -> tuple[float, float]:
    """The largest relative errors of the tractions and of the dissipation of a load segment; where contact begins, of at least `least`."""
    traction = largest = 0.0
    for one, other in zip(events.steps, result.steps):
        largest = max(largest, np.abs(one.pressure).max(), np.abs(one.shear).max())
        difference = max(np.abs(one.pressure - other.pressure).max(), np.abs(one.shear - other.shear).max())
        traction = max(traction, difference / largest)
    history = events.history
    exact, found = np.diff(history.dissipation, prepend=0), np.diff(result.history.dissipation, prepend=0)
    work = np.abs(history.normal_force * history.approach).max()
    counts = exact > max(ROUND_OFF_DISSIPATION * np.sum(exact), 1e-12 * work)
    begins = np.concatenate([[True], history.normal_force[:-1] <= 0])
    reference = np.where(begins, np.maximum(exact, least), exact)
    return traction, float(np.max(np.abs(found - exact)[counts] / reference[counts], initial=0))


def least_dissipation(scene: Scene, events: mfv.Result) -> float:
    """What the error of the dissipation is compared with where contact begins: 0.06 (mu P)^2/m, m the contact modulus."""
    lower, upper = scene.lower, scene.upper
    lower = lower.layers[0] if lower.layers else lower
    flexibility = (1 - lower.poisson_ratio) / lower.shear_modulus
    if upper.shear_modulus is not None:
        flexibility += (1 - upper.poisson_ratio) / upper.shear_modulus
    return float(0.06 * (scene.friction.mu * events.history.normal_force.max()) ** 2 * flexibility)


def study_random(
    scene: Callable[[int, Solver], Scene], seeds: range, tolerance: float, stepping: str, least: tuple[float, float]
) -> None:
    rows, solves, beyond = [], np.zeros(2, int), 0
    for seed in seeds:
        events = scene(seed, Solver(stepping="event")).run()
        result = scene(seed, Solver(stepping=stepping, accuracy=tolerance)).run()
        if events.outcome != result.outcome:
            print(f"scene {seed}: {events.outcome} by events, {result.outcome} by large increments")
        if "complete" not in (events.outcome, result.outcome) or events.outcome != result.outcome:
            continue
        solves += [events.summary.linear_solves, result.summary.linear_solves]
        traction, dissipation = differences(events, result, least_dissipation(scene(seed, Solver()), events))
        names = ("increment_traction_error", "increment_dissipation_error")
        estimates = tuple(float(result.summary[name]) if name in result.summary else 0.0 for name in names)
        rows.append((traction, estimates[0], dissipation, estimates[1]))
        if max(traction, dissipation) > tolerance:
            beyond += 1
            print(f"scene {seed}: traction {traction:.1e}, dissipation {dissipation:.1e}, estimated {estimates}")
    table = np.array(rows)
    print(f"{len(rows)} scenes, {beyond} beyond {tolerance:g}; largest errors: tractions {table[:, 0].max():.1e}, dissipation "
          f"{table[:, 2].max():.1e}; solves {solves[1]} for {solves[0]} by events ({solves[1] / solves[0]:.2f})")  # fmt: skip
    for i, name in enumerate(("tractions", "dissipation")):
        true, estimate = table[:, 2 * i], table[:, 2 * i + 1]
        erring = true > least[i]
        if erring.any():
            ratio = estimate[erring] / true[erring]
            print(f"{name}: {erring.sum()} err, {100 * np.mean(ratio >= 1):.0f} % of them by no more than estimated, "
                  f"{100 * np.mean(ratio >= 1 / 3):.0f} % by no more than three times that; median estimate/error {np.median(ratio):.1f}")  # fmt: skip


def nonlinear_scene(seed: int, solver: Solver) -> Scene:
    """Scene number `seed` of Dahl's law (even numbers) or of weakening: a rigid disk, pressed, sheared in cycles, then obliquely."""
    draw = np.random.default_rng(seed)
    mu, poisson, force = float(draw.uniform(0.1, 0.8)), float(draw.choice([0.0, 0.2, 0.3])), 0.01
    coupling, nodes = str(draw.choice(["full", "none"])), int(draw.choice([41, 61, 81]))
    if seed % 2 == 0:
        stiffness, exponent = mu * 10 ** draw.uniform(1, 2.5), draw.choice([0.5, 1, 1, 2])
        friction = Friction.dahl(mu, stiffness=float(stiffness), exponent=float(exponent))
    else:
        kinetic, distance = mu * draw.uniform(0.6, 0.95), 10 ** draw.uniform(-2.5, -1.2)
        friction = Friction.weakening(mu, float(kinetic), distance=float(distance))
    shear = float(draw.uniform(0.2, 0.7)) * mu * force
    steps = [Step(normal_force=force, friction=bool(draw.random() < 0.6)), Step(tangential_force=shear)]
    steps.append(Step(tangential_force=-shear * float(draw.uniform(0.3, 1)), cycles=2))
    if draw.random() < 0.4:
        later = {"normal_force": draw.uniform(0.6, 1.4) * force, "tangential_force": draw.uniform(-0.5, 0.8) * shear}
        steps.append(Step(**{key: float(value) for key, value in later.items()}))
    return Scene(
        Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson),
        Body.disk(1.0, rigid=True),
        mesh=Mesh(nodes=nodes),
        friction=friction,
        steps=steps,
        coupling=coupling,
        solver=solver,
        output=Output(history="steps"),
    )


def study_nonlinear(scenes: int, accuracy: float) -> None:
    rows: dict[str, list[tuple[float, float]]] = {"dahl": [], "weakening": []}
    for seed in range(scenes):
        exact = nonlinear_scene(seed, Solver(friction_tolerance=1e-6)).run()
        result = nonlinear_scene(seed, Solver(accuracy=accuracy)).run()
        if {exact.outcome, result.outcome} != {"complete"}:
            print(f"scene {seed}: {exact.outcome}, {result.outcome}")
            continue
        rows["weakening" if seed % 2 else "dahl"].append(differences(exact, result, 0.0))
    for law, errors in rows.items():
        table = np.array(errors) / accuracy
        print(f"{law}: largest and median error over the accuracy: tractions {table[:, 0].max():.2f}, {np.median(table[:, 0]):.2f}; "
              f"dissipation of a segment {table[:, 1].max():.2f}, {np.median(table[:, 1]):.2f}")  # fmt: skip


def rough_scene(seed: int, solver: Solver) -> Scene:
    """Scene number `seed` of a rough surface that repeats: a press, then shear and a cycle, a second press, or oblique loads."""
    draw = np.random.default_rng(seed)
    nodes, points, length = int(draw.choice([512, 800, 1024, 1500, 2048])), int(draw.choice([4, 8, 8, 16])), 10.0
    hurst, mu = float(draw.uniform(0.4, 1.0)), float(10 ** draw.uniform(-1, 0))
    poisson, force, share = (
        float(draw.choice([0, 0.1, 0.2, 0.3, 0.4])),
        float(10 ** draw.uniform(-1.5, -0.5)),
        float(draw.uniform(0.3, 0.85)),
    )
    profile = mfv.surfaces.self_affine(
        nodes, length, hurst=hurst, rms_slope=0.1, roll_off=0.5, cut_off=length * points / nodes, seed=seed
    )
    steps = [
        [Step(normal_force=force), Step(force_ratio=share), Step(force_ratio=-share, cycles=1)],
        [
            Step(normal_force=force),
            Step(normal_force=2 * force),
            Step(force_ratio=share),
            Step(normal_force=1.2 * force, force_ratio=0.5 * share),
        ],
        [
            Step(normal_force=force, force_ratio=0.5 * share),
            Step(force_ratio=share),
            Step(normal_force=0.6 * force, force_ratio=0.3 * share),
        ],
    ][seed % 3]
    return Scene(
        Body.half_plane(youngs_modulus=1 - poisson**2, poisson_ratio=poisson),
        Body.profile(profile.x, profile.height, rigid=True),
        mesh=Mesh(nodes=nodes, period=length),
        friction=Friction.coulomb(mu),
        steps=steps,
        coupling="full",
        solver=solver,
        output=Output(history="steps"),
    )


def study_rough(scenes: int, accuracy: float) -> None:
    names = ("tractions (rms)", "single traction", "contact length", "stick ratio", "peak shear", "dissipation of a segment")
    rows: list[list[float]] = []
    solves, taken = np.zeros(2, int), 0
    for seed in range(scenes):
        events, result = (rough_scene(seed, Solver(**how)).run() for how in ({"stepping": "event"}, {"accuracy": accuracy}))
        if {events.outcome, result.outcome} != {"complete"}:
            print(f"scene {seed}: {events.outcome}, {result.outcome}")
            continue
        solves += [events.summary.linear_solves, result.summary.linear_solves]
        taken += result.summary.leaps > 0
        largest = done = done_exact = 0.0
        for one, other in zip(events.steps, result.steps):
            exact = np.concatenate([one.pressure, one.shear])
            wrong = np.concatenate([other.pressure, other.shear]) - exact
            largest = max(largest, np.abs(exact).max())
            work = one.dissipation - done_exact
            counts = work > 0.01 * events.summary.dissipation
            rows.append(
                [
                    np.linalg.norm(wrong) / np.linalg.norm(exact),
                    np.abs(wrong).max() / largest,
                    abs(other.contact_length / one.contact_length - 1),
                    abs(other.stick_ratio - one.stick_ratio),
                    abs(np.abs(other.shear).max() / np.abs(one.shear).max() - 1),
                    abs((other.dissipation - done) / work - 1) if counts else 0.0,
                ]
            )
            done, done_exact = other.dissipation, one.dissipation
    table = np.array(rows)
    print(f"{scenes} scenes, {taken} with large increments, {len(rows)} states; solves {solves[1]} for {solves[0]} by events")
    for name, errors in zip(names, table.T):
        print(
            f"{name}: nine of ten below {np.quantile(errors, 0.9):.1e}, 95 % {np.quantile(errors, 0.95):.1e}, largest {errors.max():.1e}"
        )


if __name__ == "__main__":
    if sys.argv[1] == "cycles":
        study_cycles(int(sys.argv[2]))
    elif sys.argv[1] == "nonlinear":
        study_nonlinear(int(sys.argv[2]), float(sys.argv[3]))
    elif sys.argv[1] == "rough":
        study_rough(int(sys.argv[2]), float(sys.argv[3]))
    elif sys.argv[1] == "held-back":
        seeds, accuracy = range(HELD_BACK, HELD_BACK + int(sys.argv[2])), float(sys.argv[3])
        study_random(random_scene, seeds, accuracy, "auto", (1e-3 * accuracy, 1e-3 * accuracy))
    elif sys.argv[1] == "growing":
        seeds, accuracy = range(int(sys.argv[2])), float(sys.argv[3])
        study_random(growing_scene, seeds, accuracy, "leap", (1e-3 * accuracy, 1e-3 * accuracy))
    else:
        study_random(random_scene, range(int(sys.argv[2])), float(sys.argv[3]), "leap", (ROUND_OFF_TRACTION, ROUND_OFF_DISSIPATION))
