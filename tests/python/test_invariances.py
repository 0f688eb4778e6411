"""What must not change, or change in a known way, when a problem is stated differently: every output, not only tractions.

Random contacts are solved twice: as they are, and as their mirror image, with the bodies exchanged, in other units, and so on. All
fields are compared; the tables of truth/fields.py say which ones change their sign, their side or their body.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from truth.fields import POSITIONS, TOLERANCE, converter, differences, exchanged, is_along_the_surface, is_edge_position, mirrored

import mfv

SEEDS = range(8)


@dataclasses.dataclass
class Contact:
    """A contact to be stated in several ways; see `scene`."""

    lower: dict[str, Any]
    upper: dict[str, Any]
    friction: dict[str, Any]
    half_width: float
    force: float
    ratios: tuple[float, ...]
    coupling: str = "full"
    plane: str = "strain"
    nodes: int = 37
    normals: str = "vertical"
    frictionless_press: bool = True
    cycles: int = 1
    refine: str | None = None
    solver: dict[str, Any] = dataclasses.field(default_factory=dict)
    #: Bulk stresses of the lower and the upper body over that ratio of the forces; None: none.
    bulk: tuple[float | None, float | None] = (None, None)

    def strain(self, ratio: float) -> dict[str, float]:
        """The bulk stresses that go with a ratio of the forces."""
        return {f"{body}_bulk_stress": ratio * stress for body, stress in zip(("lower", "upper"), self.bulk) if stress is not None}

    def steps(self, sign: float = 1.0, pieces: int = 1) -> Iterator[mfv.Step]:
        """Press, shear to each force in turn, with bulk stresses in proportion; the last one in cycles."""
        yield mfv.Step(normal_force=self.force, friction=not self.frictionless_press)
        largest = self.friction.get("mu", self.friction.get("mu_kinetic"))
        before = 0.0
        for number, ratio in enumerate(self.ratios):
            limit = sign * largest * self.force
            last = number == len(self.ratios) - 1 and self.cycles > 0
            for piece in range(pieces - 1 if not last else 0):
                between = before + (ratio - before) * (piece + 1) / pieces
                yield mfv.Step(tangential_force=between * limit, **self.strain(between))
            yield mfv.Step(tangential_force=ratio * limit, cycles=self.cycles if last else None, **self.strain(ratio))
            before = ratio

    def scene(self, **changes: Any) -> mfv.Scene:
        steps = changes.pop("steps", None) or list(self.steps())
        keys = {"coupling": self.coupling, "plane": self.plane, **changes}
        normals = None if self.normals == "vertical" else self.normals
        return mfv.Scene(
            mfv.Body(**self.lower),
            mfv.Body(**self.upper),
            mesh=mfv.Mesh(nodes=self.nodes, half_width=1.3 * self.half_width, normals=normals, refine=self.refine),
            friction=mfv.Friction(**self.friction),
            solver=mfv.Solver(**self.solver),
            steps=steps,
            **keys,
        )

    def run(self, **changes: Any) -> mfv.Result:
        result = self.scene(**changes).run()
        assert result.outcome == "complete", result.message
        return result


def contact(seed: int, **changes: Any) -> Contact:
    """Contact number `seed`: shapes, materials, coupling, law, loads."""
    random = np.random.default_rng(seed)

    def material() -> dict[str, float]:
        return {"shear_modulus": 10 ** random.uniform(-1, 1), "poisson_ratio": random.uniform(0.0, 0.45)}

    radius = 10 ** random.uniform(-1, 1)
    upper = {"shape": "disk", "radius": radius, **(material() if random.random() < 0.6 else {"rigid": True})}
    lower = {"shape": "half_plane", **material()}
    kind = seed % 4
    if kind == 1:
        lower = {"shape": "disk", "radius": radius * random.uniform(1, 2), **material()}
    if kind == 2:
        lower = {"shape": "hole", "radius": radius * random.uniform(1.3, 2), **material()}
    curvature = 1 / radius + {1: 1, 2: -1}.get(kind, 0) / lower.get("radius", 1.0)
    compliance = sum((1 - b["poisson_ratio"]) / (2 * b["shear_modulus"]) for b in (lower, upper) if "shear_modulus" in b)
    half_width = 0.03 * radius
    force = np.pi * half_width**2 * curvature / (8 * compliance / 2)
    mu = random.uniform(0.2, 0.8)
    reference = {
        "lower": lower,
        "upper": upper,
        "friction": {"law": "coulomb", "mu": mu},
        "half_width": half_width,
        "force": force,
        "ratios": (random.uniform(0.3, 0.8), -random.uniform(0.3, 0.8)),
        "coupling": ("full", "goodman", "none")[seed % 3],
        "frictionless_press": bool(random.random() < 0.4),
        "nodes": 36 + seed % 2,
    }
    return Contact(**{**reference, **changes})


def strained(seed: int) -> Contact:
    """Contact number `seed` of bodies that deform like half-planes, with bulk stresses of those that are elastic: in or out of phase
    with the shear, small and large."""
    case = contact(4 * (seed + 10))
    random = np.random.default_rng(seed + 100)
    case.upper = {**case.upper, "shape": "power", "coefficient": 0.5 / case.upper["radius"], "exponent": 2.0}
    del case.upper["radius"]
    case.coupling = ("full", "none", "goodman")[seed % 3]
    pressure = 2 * case.friction["mu"] * case.force / (np.pi * case.half_width)
    lower, upper = (pressure * random.choice([-1, 1]) * 10 ** random.uniform(-1, 1) for _ in range(2))
    case.bulk = (None if seed == 1 else lower, None if case.upper.get("rigid") else upper)
    return case


def mirror_differences(case: Contact, tolerance: float = TOLERANCE) -> dict[str, float]:
    """Differences of a contact from its mirror image."""
    return differences(case.run(), case.run(steps=list(case.steps(sign=-1.0))), mirrored, tolerance=tolerance)


def exchange_differences(case: Contact, tolerance: float = TOLERANCE) -> dict[str, float]:
    """Differences of a contact from the same with the lower body as the upper one."""
    other = dataclasses.replace(case, lower=case.upper, upper=case.lower, bulk=case.bulk[::-1])
    return differences(case.run(), other.run(), exchanged, common="rigid" in case.upper, tolerance=tolerance)


KINDS = (contact, strained)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_mirror_image(seed: int, kind: Callable[[int], Contact]) -> None:
    assert mirror_differences(kind(seed)) == {}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_bodies_exchanged(seed: int, kind: Callable[[int], Contact]) -> None:
    assert exchange_differences(kind(seed)) == {}


def stretched(case: Contact, length: float, stress: float) -> Contact:
    """The same contact with other units of length and stress."""
    factors = {
        "radius": length, "coefficient": 1.0 / length, "shear_modulus": stress, "youngs_modulus": stress,
        "weakening_distance": length, "stiffness": stress / length,
    }  # fmt: skip

    def scaled(keys: dict[str, Any]) -> dict[str, Any]:
        return {key: value * factors[key] if key in factors else value for key, value in keys.items()}

    return dataclasses.replace(
        case,
        lower=scaled(case.lower),
        upper=scaled(case.upper),
        friction=scaled(case.friction),
        half_width=case.half_width * length,
        force=case.force * stress * length,
        bulk=tuple(None if bulk is None else bulk * stress for bulk in case.bulk),
    )


def unit_differences(case: Contact, seed: int, tolerance: float = TOLERANCE) -> dict[str, float]:
    """Differences of a contact from the same in other units of length and stress, drawn at random."""
    length, stress = 10.0 ** np.random.default_rng(seed).uniform(-4, 4, 2)
    other = stretched(case, length, stress)
    return differences(case.run(), other.run(), converter(length, stress), tolerance=tolerance)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS)
def test_other_units(seed: int, kind: Callable[[int], Contact]) -> None:
    assert unit_differences(kind(seed), seed) == {}


@pytest.mark.parametrize("seed", SEEDS)
def test_mirror_image_bodies_exchanged_and_units_on_refined_meshes(seed: int) -> None:
    case = contact(seed, refine="edges", nodes=90)
    first = case.run()
    assert len(np.unique(np.round(first.mesh.width / first.mesh.width.max(), 6))) > 10
    # Round-off moves the edges that the mesh is made of, and with them intervals of 1e-5 of the contact.
    for other, change in (
        (case.run(steps=list(case.steps(sign=-1.0))), mirrored),
        (dataclasses.replace(case, lower=case.upper, upper=case.lower).run(), exchanged),
        (stretched(case, 1024.0, 1.0 / 64.0).run(), converter(1024.0, 1.0 / 64.0)),
    ):
        found = differences(first, other, change, common="rigid" in case.upper, tolerance=1e-6)
        # The largest pressure is at the node nearest to a flat maximum.
        assert found.keys() <= {"observables/largest_pressure_x", "cycles/largest_pressure_x"}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("accuracy", (1e-2, 1e-3))
def test_large_increments(seed: int, accuracy: float) -> None:
    """The reduced system solves exactly, and the statuses do not depend on the statement."""
    case = contact(seed, nodes=160 + seed % 2, solver={"stepping": "leap", "accuracy": accuracy, "linear_solver": "reduced"})
    assert mirror_differences(case) == {}
    assert exchange_differences(case) == {}
    assert unit_differences(case, seed) == {}


@pytest.mark.parametrize("seed", SEEDS)
def test_large_increments_by_iteration(seed: int) -> None:
    """Within an interval fully coupled contacts are solved to 1e-5 of the accuracy, which stays in the slip of nodes that have stuck
    there."""
    accuracy = 1e-3
    case = contact(seed, nodes=160 + seed % 2, solver={"stepping": "leap", "accuracy": accuracy, "linear_solver": "fft"})
    tolerance = 1e-2 * accuracy if case.coupling == "full" else TOLERANCE
    assert mirror_differences(case, tolerance) == {}
    assert exchange_differences(case, tolerance) == {}
    assert unit_differences(case, seed, tolerance) == {}


LAWS = {
    "weakening": {"law": "weakening", "mu_static": 0.5, "mu_kinetic": 0.35, "weakening_distance": 2.0e-4},
    "dahl": {"law": "dahl", "mu": 0.5, "stiffness": 300.0},
}


@pytest.mark.parametrize(("waves", "nodes"), [(False, 600), (False, 601), (True, 600), (True, 601), (True, 700), (True, 701)])
def test_growing_stick_zones_by_both_solvers(waves: bool, nodes: int) -> None:
    """Slip at fronts in the rows of both solvers: the same increments; even and odd numbers of nodes; mirror images."""

    def steps(sign: float, solver: str) -> list[Any]:
        mesh = mfv.Mesh(nodes=nodes, period=2.6) if waves else mfv.Mesh(nodes=nodes, half_width=1.3)
        upper = mfv.Body.wave(0.004, 2.6, rigid=True) if waves else mfv.Body.disk(50.0, rigid=True)
        loads = [
            mfv.Step(normal_force=0.006),
            mfv.Step(normal_force=0.009, tangential_force=sign * 1.2e-3),
            mfv.Step(tangential_force=-sign * 1.2e-3, cycles=1),
        ]
        lower = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.2)
        scene = mfv.Scene(lower, upper, mesh=mesh, friction=mfv.Friction.coulomb(0.4), steps=loads, coupling="full")
        scene.solver = mfv.Solver(accuracy=1e-2, stepping="leap", linear_solver=solver)
        result = scene.run()
        assert result.summary.leaps > 0
        increments.append(int(result.summary.leaps))
        return list(result.steps)

    increments: list[int] = []
    iterated = steps(1.0, "fft")
    for one, direct, mirrored_one in zip(iterated, steps(1.0, "reduced"), steps(-1.0, "fft"), strict=True):
        peak = one.pressure.max()
        assert one.shear == pytest.approx(direct.shear, rel=0, abs=1e-8 * peak)
        assert one.shear == pytest.approx(-mirrored_one.shear[::-1], rel=0, abs=1e-8 * peak)
    assert len(set(increments)) == 1


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("seed", (0, 1))
def test_mirror_image_bodies_exchanged_and_units_under_other_laws(law: str, seed: int) -> None:
    case = contact(seed, friction=LAWS[law], lower={"shape": "half_plane", "shear_modulus": 1.0, "poisson_ratio": 0.2})
    case = dataclasses.replace(case, upper={"shape": "disk", "radius": 1.0, "rigid": True}, half_width=0.03, force=1.5e-3)
    # Dahl's law is integrated with increments that are chosen by their estimated error: friction_tolerance, 1e-4 by default.
    tolerance = 1e-4 if law == "dahl" else TOLERANCE
    first = case.run()
    assert differences(first, case.run(steps=list(case.steps(sign=-1.0))), mirrored, tolerance=tolerance) == {}
    other = dataclasses.replace(case, lower=case.upper, upper=case.lower)
    assert differences(first, other.run(), exchanged, common=True, tolerance=tolerance) == {}
    other = stretched(case, 1024.0, 1.0 / 64.0)
    same = {"state/pressure": 1.0 / 64.0, "state/shear": 1.0 / 64.0, "summary/contact_half_width": 1024.0}
    for path, factor in same.items():
        group, name = path.split("/")
        values = getattr(other.run(), group)[name]
        np.testing.assert_allclose(values, factor * getattr(first, group)[name], rtol=0, atol=1e-8 * np.max(np.abs(values)))


@pytest.mark.parametrize("seed", SEEDS[:4])
def test_plane_stress_is_plane_strain_of_another_ratio(seed: int) -> None:
    """Kolosov's constant is (3 - nu)/(1 + nu) in plane stress, 3 - 4 nu in plane strain: nu/(1 - nu) has the kappa of nu."""
    case = contact(seed)

    def in_plane_stress(body: dict[str, Any]) -> dict[str, Any]:
        if "poisson_ratio" not in body:
            return body
        return {**body, "poisson_ratio": body["poisson_ratio"] / (1.0 - body["poisson_ratio"])}

    def small(body: dict[str, Any]) -> dict[str, Any]:
        return {**body, "poisson_ratio": 0.7 * body["poisson_ratio"]} if "poisson_ratio" in body else body

    strain = dataclasses.replace(case, lower=small(case.lower), upper=small(case.upper))
    stress = dataclasses.replace(strain, lower=in_plane_stress(strain.lower), upper=in_plane_stress(strain.upper), plane="stress")
    assert differences(strain.run(), stress.run()) == {}


@pytest.mark.parametrize("coupling", ("full", "none"))
def test_shifted_profile(coupling: str) -> None:
    nodes, half_width, intervals = 60, 0.06, 5
    interval = 2 * half_width / nodes
    x = np.linspace(-0.2, 0.2, 4001)
    keys = {
        "mesh": mfv.Mesh(nodes=nodes, half_width=half_width),
        "friction": mfv.Friction.coulomb(0.5),
        "coupling": coupling,
        "steps": [mfv.Step(normal_force=1.2e-3), mfv.Step(tangential_force=3e-4), mfv.Step(tangential_force=-3e-4, cycles=1)],
    }
    plane = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.1, datum=1.0)
    centred, moved = (
        mfv.Scene(plane, mfv.Body.profile(x + shift, x**2 / 2, rigid=True), **keys).run() for shift in (0.0, intervals * interval)
    )

    def shifted(name: str, unit: str, values: np.ndarray) -> tuple[str, np.ndarray]:
        if name in POSITIONS or (is_edge_position(name) and unit == "length"):
            moved_along = np.roll(values, intervals) if is_along_the_surface(name) else values
            return name, moved_along + intervals * interval
        return name, np.roll(values, intervals) if name in ("pressure", "shear", "friction_work") else values

    # Displacements and gaps of single nodes are of other nodes; the middle is not where x is 0.
    skipped = {"gap", "slip", "normal_displacement", "tangential_displacement", "moment"}
    found = differences(centred, moved, shifted)
    assert {path for path in found if path.split("/")[1] not in skipped and "patch_shift" not in path} == set()


def compliance_of_a_half_plane(x: np.ndarray, width: np.ndarray, modulus: float, nu: float, datum: float) -> np.ndarray:
    """Nodal compliances (normal components before tangential ones) of boxes around x; docs/theory.md."""
    kappa, distance = 3 - 4 * nu, x[:, None] - x
    left, right = distance - width / 2, distance + width / 2
    integral = right * (np.log(datum / abs(right)) + 1) - left * (np.log(datum / abs(left)) + 1)
    direct = (kappa + 1) / (4 * np.pi * modulus) * integral
    cross = (kappa - 1) / (8 * modulus) * 2 * np.clip(distance, -width / 2, width / 2)
    return np.block([[direct, cross], [-cross, direct]]) / np.tile(width, 2)


@pytest.mark.parametrize("coupling", ("full", "goodman", "none"))
def test_a_matrix_of_a_half_plane_is_the_half_plane(coupling: str) -> None:
    case = contact(0, coupling=coupling, nodes=41)
    case.lower = {"shape": "half_plane", "shear_modulus": 1.3, "poisson_ratio": 0.25, "datum": 2.0}
    case.upper = {"shape": "disk", "radius": 1.0, "rigid": True}
    case.half_width, case.force = 0.03, 2e-3
    interval = 2 * 1.3 * case.half_width / case.nodes
    x = (np.arange(case.nodes) - (case.nodes - 1) / 2) * interval
    width = np.full(case.nodes, interval)
    matrix = compliance_of_a_half_plane(x, width, 1.3, 0.25, 2.0)
    keys = {"coupling": coupling, "friction": mfv.Friction(**case.friction), "steps": list(case.steps())}
    body = mfv.Body.matrix(x, compliance=matrix, width=width)
    # The exponent of the pressure at the edge under slip is known for materials, and estimated for a matrix.
    found = differences(
        case.run(),
        mfv.Scene(body, mfv.Body(**case.upper), **keys).run(),
        common=True,
        tolerance=2e-4 if coupling == "full" else TOLERANCE,
    )
    if coupling == "full":  # fields of edges have that exponent
        found = {path: error for path, error in found.items() if not path.split("/")[1].startswith(("left_", "right_"))}
    assert found == {}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS[:4])
def test_split_steps(seed: int, kind: Callable[[int], Contact]) -> None:
    case = kind(seed)
    assert differences(case.run(), case.run(steps=list(case.steps(pieces=4)))) == {}


def test_only_the_difference_of_the_strains_acts() -> None:
    """Equal strains of both bodies change their own stresses and displacements, but nothing between them. (A loss factor is defined
    for cycles of shear alone.)"""
    material = {"shear_modulus": 1.0, "poisson_ratio": 0.3}
    case = strained(0)
    case.lower, case.upper = {**case.lower, **material}, {"shape": "power", "coefficient": 0.5, "exponent": 2.0, **material}
    case.half_width, case.force = 0.03, 7e-4
    none, both = (dataclasses.replace(case, bulk=(stress, stress)).run() for stress in (0.0, 1e-2))
    own = ("bulk_stress", "tension", "loss_factor", "upper_tangential_displacement", "tangential_displacement")
    assert {path for path in differences(none, both) if not path.endswith((*own, "tension_x"))} == set()


@pytest.mark.parametrize("seed", SEEDS[:4])
def test_cycles_are_explicit_steps(seed: int) -> None:
    case = contact(seed, cycles=2)
    *before, press_to, last = case.steps()
    there, back = last.tangential_force, press_to.tangential_force
    explicit = [*before, press_to, *(mfv.Step(tangential_force=force) for force in (there, back, there, back))]
    cycles, steps = case.run(), case.run(steps=explicit)
    # Only a step with cycles has observables of cycles.
    ending = {f"{group}/{name}" for group in ("state", "summary") for name in getattr(steps, group)}
    assert ending & differences(cycles, steps, common=True).keys() == set()


@pytest.mark.parametrize("coupling", ("goodman", "none"))
@pytest.mark.parametrize("seed", SEEDS[:4])
def test_forces_and_displacements_that_belong_together(seed: int, coupling: str) -> None:
    """(Where shear moves the approach, as with full coupling, paths between the same ends differ.)"""
    case = contact(seed, coupling=coupling, cycles=0)
    by_force = case.run()
    states = list(by_force.steps)
    motions = [mfv.Step(approach=float(states[0].approach), friction=not case.frictionless_press)]
    motions += [mfv.Step(approach=float(state.approach), shift=float(state.shift)) for state in states[1:]]
    by_motion = case.run(steps=motions)
    found = {path for path in differences(by_force, by_motion, common=True) if not path.startswith("observables/")}
    assert found == set()


@pytest.mark.parametrize("frictionless", (True, False))
def test_equal_bodies_do_not_couple(frictionless: bool) -> None:
    body = {"shape": "disk", "radius": 0.5, "shear_modulus": 1.0, "poisson_ratio": 0.2}
    case = Contact(body, body, {"law": "coulomb", "mu": 0.6}, 0.02, 1.0e-3, (0.6, -0.5), frictionless_press=frictionless)
    full, none = case.run(coupling="full"), case.run(coupling="none")
    displacements = {f"state/{name}" for name in full.state if "displacement" in name}  # each body couples by itself
    assert differences(full, none).keys() <= displacements


def test_laws_with_equal_coefficients_are_coulombs() -> None:
    case = contact(4, coupling="full")
    mu = case.friction["mu"]
    coulomb = case.run()
    for law in ({"law": "static_kinetic"}, {"law": "weakening", "weakening_distance": 1e-3}):
        other = dataclasses.replace(case, friction={**law, "mu_static": mu, "mu_kinetic": mu})
        steps = list(case.steps())
        assert differences(coulomb, other.run(steps=steps)) == {}, law


def test_dahls_law_tends_to_coulombs() -> None:
    case = contact(0, coupling="none", frictionless_press=True, cycles=0)
    shear = case.run().state.shear
    modulus = case.lower["shear_modulus"] / case.half_width
    errors = []
    for stiffness in (1e2, 1e3, 1e4):
        dahl = dataclasses.replace(case, friction={**case.friction, "law": "dahl", "stiffness": stiffness * modulus})
        errors.append(np.max(np.abs(dahl.run().state.shear - shear)) / np.max(np.abs(shear)))
    assert errors[0] > 3 * errors[1] > 9 * errors[2], errors


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", SEEDS[:4])
def test_linear_solvers(seed: int, kind: Callable[[int], Contact]) -> None:
    case = kind(seed)
    first = case.run()
    for solver in ("reduced", "dgesv", "fft"):
        keys = {"linear_solver": solver, **({"linear_tolerance": 1e-12} if solver == "fft" else {})}
        assert differences(first, dataclasses.replace(case, solver=keys).run()) == {}, solver
