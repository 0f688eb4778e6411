"""Matrix bodies on meshes of any widths: everything that is read off a result, against the half-plane and closed forms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from matrix_bodies import graded, half_plane, skew

import mfv

R, MU, P, Q, H = 0.25, 0.7, 1.0e-3, 4.0e-4, 5.0e-4
STEPS = (mfv.Step(normal_force=P), mfv.Step(tangential_force=Q), mfv.Step(tangential_force=-Q, cycles=2))

#: What is not the physics: work done, round-off, and what the matrix body does not know of its material.
WORK = (
    "leaps",
    "linear_solves",
    "largest_residual",
    "cycle_change",
    "change",
    "shift_drift",
    "dissipation_number",
    "stiffness_number",
)


def solved(body: mfv.Body, coupling: str, mesh: mfv.Mesh | None = None, steps: tuple[mfv.Step, ...] = STEPS) -> mfv.Result:
    """A rigid cylinder on a body, pressed and sheared to and fro."""
    scene = mfv.Scene(
        body,
        mfv.Body.disk(R, rigid=True),
        mesh=mesh or mfv.Mesh(),
        friction=mfv.Friction.coulomb(MU),
        coupling=coupling,
        steps=steps,
    )
    return mfv.run(scene, check=True)


def read_off(result: mfv.Result) -> Iterator[tuple[str, np.ndarray]]:
    """All quantities that are derived from tractions and motions, by group and name."""
    for group in ("summary", "observables", "cycles", "patches"):
        for name, values in getattr(result, group).items():
            # A matrix has no inside with stresses.
            if name not in WORK and "tension" not in name and np.shape(values) != result.mesh.x.shape:
                yield f"{group}.{name}", np.asarray(values, dtype=float)


@pytest.mark.parametrize(
    ("coupling", "poisson_ratio", "tolerance"), [("none", 0.3, 1e-9), ("goodman", 0.3, 1e-9), ("full", 0.0, 2e-3)]
)
def test_equal_widths_give_what_the_half_plane_gives(coupling: str, poisson_ratio: float, tolerance: float) -> None:
    """All that is read off. With full coupling the edges hang on Dundurs' beta, which the matrix tells to 0.5 %."""
    plane = solved(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson_ratio, datum=1.0),
        coupling,
        mfv.Mesh(nodes=65, half_width=32.5 * H),
    )
    matrix = solved(half_plane(plane.mesh.x, plane.mesh.width, 1.0, poisson_ratio, 1.0, mean=False), coupling)
    given = dict(read_off(matrix))
    for name, expected in read_off(plane):
        of_edge = name.split(".")[-1].startswith(("left_", "right_"))
        if name.endswith("steady_stick_length") or (
            of_edge and coupling == "full"
        ):  # of half-planes; with the exponent of the edge
            continue
        scale = P if name.endswith("force") else 1.0 if "patch_shift" in name or "centre" in name else np.nanmax(np.abs(expected))
        if name.endswith("_force_work"):  # round-off where the force is constant
            scale = np.max(plane.cycles.dissipation)
        np.testing.assert_allclose(given[name], expected, atol=tolerance * float(scale), rtol=0.0, err_msg=name)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3])
def test_widths_that_grow_outside_the_contact_change_nothing(poisson_ratio: float) -> None:
    """61 intervals of 5e-4 in the contact growing by 1.25 outwards: half-width and stick ratio of Hertz and Mindlin."""
    x, width = graded(61, H, 1.25, (17, 18))
    result = solved(
        half_plane(x, width, 1.0, poisson_ratio, 1.0), "none", steps=(mfv.Step(normal_force=P, friction=False), STEPS[1])
    )
    exact = float(mfv.reference.hertz_half_width(P, R, 1.0, 3.0 - 4.0 * poisson_ratio))
    seen = result.observables
    assert seen.contact_half_width == pytest.approx(exact, abs=0.1 * H)
    assert seen.stick_ratio == pytest.approx(np.sqrt(1.0 - Q / (MU * P)), abs=0.01)
    assert seen.pressure_number == pytest.approx(1.0, abs=0.005)
    assert result.summary.stick_right == pytest.approx(exact * np.sqrt(1.0 - Q / (MU * P)), abs=0.1 * H)
    assert seen.contact_centre == pytest.approx(0.0, abs=1e-9 * H)


@pytest.mark.parametrize("growth", [1.02, 1.0 / 1.02, 1.03])
def test_a_skew_mesh_does_not_shift_a_symmetric_patch(growth: float) -> None:
    """Edges to a tenth of the intervals that are there, whatever the widths elsewhere."""
    x, width = skew(81, H, growth)
    result = solved(half_plane(x, width, 1.0, 0.3, 1.0), "none", steps=(mfv.Step(normal_force=P, friction=False), STEPS[1]))
    exact = float(mfv.reference.hertz_half_width(P, R, 1.0, 1.8))
    for name, place in (("contact_left", -exact), ("contact_right", exact)):
        assert result.summary[name] == pytest.approx(place, abs=0.1 * np.interp(place, x, width)), name
    assert abs(result.observables.contact_centre) < 0.1 * width[(x > -exact) & (x < exact)].max()


def test_stick_ratio_of_unequal_widths_is_one_of_lengths() -> None:
    """Node counts do not give lengths if widths differ."""
    x, width = skew(81, H, 1.05)
    result = solved(half_plane(x, width, 1.0, 0.3, 1.0), "none", steps=(mfv.Step(normal_force=P, friction=False), STEPS[1]))
    status, touching = result.state.status, result.state.status != mfv.NodeStatus.OPEN
    share = width[status == mfv.NodeStatus.STICK].sum() / width[touching].sum()
    assert result.summary.stick_ratio == pytest.approx(share, abs=0.1)
    counted = np.mean(status[touching] == mfv.NodeStatus.STICK)
    assert abs(result.summary.stick_ratio - share) < abs(result.summary.stick_ratio - counted)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.2])
def test_full_coupling_of_a_matrix_has_the_exponent_of_its_beta(poisson_ratio: float) -> None:
    """Edges within a tenth of an interval of those of the half-plane on a fine mesh."""
    steps = STEPS[:2]
    nodes, half = 101, 0.016
    body = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=poisson_ratio, datum=1.0)
    fine = solved(body, "full", mfv.Mesh(nodes=641, half_width=half), steps).summary
    coarse = solved(body, "full", mfv.Mesh(nodes=nodes, half_width=half), steps)
    matrix = solved(half_plane(coarse.mesh.x, coarse.mesh.width, 1.0, poisson_ratio, 1.0, mean=False), "full", steps=steps).summary
    interval = 2.0 * half / nodes
    for name in ("contact_left", "contact_right"):
        assert matrix[name] == pytest.approx(coarse.summary[name], abs=5e-3 * interval), name
        assert matrix[name] == pytest.approx(fine[name], abs=0.1 * interval), name
