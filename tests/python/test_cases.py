"""Cases that were wrong, or ended early, and said nothing (docs/verification.md): against finer meshes, other solvers, every cycle and
the mirror image."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mfv

CASES = Path(__file__).parents[1] / "cases"


@pytest.fixture
def run(tmp_path: Path):
    """Run a case of tests/cases, changed by pairs of texts."""
    for table in CASES.glob("*.txt"):
        shutil.copy(table, tmp_path)

    def run_case(name: str, *changes: tuple[str, str]) -> mfv.Result:
        text = (CASES / f"{name}.nml").read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "case.nml"
        path.write_text(text)
        return mfv.run(path)

    return run_case


def test_wear_is_that_of_every_cycle(run) -> None:
    blocks, single = (run("wear_runaway", *change).observables.worn_area for change in ((), [("&wear ", "&wear block=1, ")]))
    assert blocks == pytest.approx(single, rel=0.05)


def test_an_accuracy_holds_in_every_segment(run) -> None:
    def by_segment(result: mfv.Result) -> np.ndarray:
        step, dissipation = result.history.step, result.history.dissipation
        return np.diff([dissipation[step == number][-1] for number in np.unique(step)])

    found = by_segment(run("accuracy_nested"))
    exact = by_segment(run("accuracy_nested", ("accuracy=3e-3", "accuracy=0, stepping='event'")))
    large = exact > 1e-12 * exact.max()
    assert np.all(np.abs(found - exact)[large] <= 3e-3 * exact[large])


def test_round_off_decides_nothing(run) -> None:
    results = [
        run("edge_by_round_off"),
        run("edge_by_round_off", ("shift=-", "shift="), ("moment=-", "moment=")),
    ]
    for name in ("upper_tension", "lower_tension", "stick_ratio", "smallest_stick_ratio"):
        one, other = (result.observables[name] for result in results)
        assert one == pytest.approx(other, rel=1e-9)


def test_a_refined_half_width_is_within_its_bar(run) -> None:
    refined, fine = run("edges_half_width"), run("edges_half_width", ("refine='edges'", "nodes=1212"))
    bar = refined.error_estimate.contact_half_width_error
    assert bar < 1e-4 * fine.observables.contact_half_width
    assert abs(refined.observables.contact_half_width - fine.observables.contact_half_width) < bar


@pytest.mark.parametrize(("name", "quantity"), [("narrow_backslip", "stick_ratio"), ("unresolved_bar", "cycle_dissipation")])
def test_what_slip_zones_without_nodes_decide_is_not_resolved(run, name: str, quantity: str) -> None:
    coarse = run(name)
    fine = run(name, ("&friction", "&mesh refine='edges', nodes=400 /\n&friction"))
    assert abs(coarse.observables[quantity] / fine.observables[quantity] - 1) > 5e-4
    assert np.isnan(coarse.error_estimate[f"{quantity}_error"])
    assert quantity in coarse.attributes["unresolved"].split()


def test_the_pressure_of_a_wedge_has_no_limit_on_any_mesh(run) -> None:
    for mesh in ("nodes=102, refine='edges'", "nodes=102", "nodes=204"):
        assert np.isinf(run("wedge_edges", ("nodes=102, refine='edges'", mesh)).error_estimate.peak_pressure_error)


def test_the_tension_behind_a_wedge_does_not_depend_on_the_parity_of_nodes(run) -> None:
    results = [run("wedge_tip_tension", ("nodes=606", f"nodes={nodes}")) for nodes in (101, 102, 303)]
    tensions = [result.observables.lower_tension for result in results]
    assert np.ptp(tensions) < 1e-3 * tensions[-1]
    bars = [result.error_estimate.lower_tension_error for result in results]
    assert not np.any(np.abs(tensions[-1] - np.array(tensions)) > 2.0 * np.array(bars))  # NaN: not resolved


@pytest.mark.parametrize(
    ("name", "solver", "others"),
    [
        ("refine_dgesv", "dgesv", ("fft", "reduced")),
        ("fft_goodman_weakening", "fft", ("reduced", "dgesv")),
    ],
)
def test_linear_solvers_do_not_change_what_happens(run, name: str, solver: str, others: tuple[str, ...]) -> None:
    results = [run(name, (f"'{solver}'", f"'{other}'")) for other in (solver, *others)]
    for result in results:
        assert result.outcome == "complete"
        assert result.summary.largest_residual < 1e-8
        assert result.observables.dissipation == pytest.approx(results[0].observables.dissipation, rel=1e-7)


@pytest.mark.parametrize("solver", ["reduced", "fft"])
def test_a_signal_that_returns_to_an_earlier_extreme_goes_on(run, solver: str) -> None:
    result = run("case_signal_short", ("&friction", f"&solver linear_solver='{solver}', stepping='event' /\n&friction"))
    assert result.outcome == "complete"
    assert result.observables.dissipation == pytest.approx(run("case_signal_short").observables.dissipation, rel=1e-3)


def test_an_inadmissible_state_is_not_complete(run) -> None:
    result = run("conventional_weakening")
    assert result.outcome == "inadmissible"
    assert "friction limit" in result.message
    assert result.summary.largest_residual < 1e-8


@pytest.mark.parametrize("law", [{"law": "static_kinetic"}, {"law": "weakening", "weakening_distance": 1e-8}])
def test_friction_that_falls_within_an_interval_is_not_resolved(law: dict[str, Any]) -> None:
    """On any mesh at once; over a slip on coarse ones. The prescribed force is exact."""

    def sheared(nodes: int, **keys: Any) -> mfv.Result:
        return mfv.Scene(
            mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
            mfv.Body.disk(1.0, shear_modulus=1.0, poisson_ratio=0.3),
            mesh=mfv.Mesh(nodes=nodes),
            friction=mfv.Friction(**keys),
            output=mfv.Output(error_estimate=True),
            steps=[mfv.Step(normal_force=1e-3), mfv.Step(tangential_force=3e-4)],
        ).run(check=True)

    found = sheared(61, mu_static=0.5, mu_kinetic=0.4, **law)
    assert {"stick_ratio", "peak_shear", "dissipation"} <= set(found.unresolved)
    assert not {"tangential_force", "contact_half_width", "peak_pressure"} & set(found.unresolved)
    assert "stick_ratio" not in sheared(61, law="weakening", mu_static=0.5, mu_kinetic=0.4, weakening_distance=1e-3).unresolved
    assert (
        "stick_ratio"
        not in sheared(61, law=law["law"], mu_static=0.5, mu_kinetic=0.5, **{k: v for k, v in law.items() if k != "law"}).unresolved
    )


def test_dimensionless_numbers_have_the_bars_of_their_factors() -> None:
    result = mfv.Scene(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
        mfv.Body.disk(1.0, shear_modulus=1.0, poisson_ratio=0.3),
        mesh=mfv.Mesh(nodes=61),
        friction=mfv.Friction.coulomb(0.5),
        output=mfv.Output(error_estimate=True),
        steps=[mfv.Step(normal_force=1e-3), mfv.Step(tangential_force=3e-4), mfv.Step(tangential_force=-3e-4, cycles=1)],
    ).run(check=True)

    def relative(name: str) -> float:
        return float(result.error_bar(name) / result.observables[name])

    assert relative("dissipation_number") == pytest.approx(relative("cycle_dissipation"), rel=1e-12)
    assert relative("stiffness_number") == pytest.approx(relative("tangential_stiffness"), rel=1e-12)
    assert relative("shear_number") == pytest.approx(relative("peak_shear") + relative("contact_half_width"), rel=1e-12)
    assert "force_number_error" not in result.error_estimate
