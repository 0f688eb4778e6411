"""Parameters from measured loops: against closed forms, many seeds of noise, and the numbers of a published test."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from rig_defects import DEFECTS, Rig, tried
from scenes import PROJECT

import mfv
from mfv import Axis, Body, Friction, Mesh, Scene, Step, errors, identify
from mfv.commands import main
from mfv.identify import Loop, Priors
from mfv.identify.path import path_of

P, MU, E, NU, RADIUS = 100.0, 0.45, 70000.0, 0.3, 10.0
TRUTH = {"friction%mu": MU, "rig_stiffness": 1.0e5}
START = {"friction%mu": 0.6, "rig_stiffness": 7.0e4}
#: A rig without systematic errors.
NOTHING_WRONG = Priors(lag=0.0, drift=0.0, offset=0.0)
#: dU/dQ = COMPLIANCE (constant - ln(1 - Q/(mu P))): two equal half-planes, (kappa + 1)/(4 pi G) = 2 (1 - nu^2)/(pi E) for ln(1/a).
COMPLIANCE = 2.0 * (1.0 - NU**2) / (math.pi * E)


def cylinders(nodes: int = 61) -> Scene:
    """A cylinder on a half-plane of the same material: no coupling, Cattaneo and Mindlin's problem."""
    lower, upper = (
        Body.half_plane(youngs_modulus=E, poisson_ratio=NU),
        Body.disk(RADIUS, youngs_modulus=E, poisson_ratio=NU),
    )
    return Scene(lower, upper, friction=Friction.coulomb(1.0), mesh=Mesh(nodes=nodes, gap="parabolic"), coupling="none")


def measured(ratio: float, noise: float, force_noise: float = 0.0, seed: int | None = None, nodes: int = 61) -> Loop:
    """A synthetic loop up to `ratio` of the sliding limit; noise as a part of the amplitudes of shift and force."""
    planned = Loop.planned(P, ratio * MU * P, shift_noise=1.0, force_noise=force_noise * ratio * MU * P)
    (exact,) = identify.simulate(cylinders(nodes), planned, TRUTH)
    planned.shift_noise = noise * 0.5 * float(np.ptp(exact.shift))
    (loop,) = identify.simulate(cylinders(nodes), planned, TRUTH, seed=seed)
    return loop


def nonlinear(force: np.ndarray, mu: float) -> np.ndarray:
    """The shift of the first loading beyond its linear part, from Ciavarella and Jaeger: U(Q) = mu (d(P) - d(P - Q/mu)) where the
    approach of a cylinder has d'(P) = constant - COMPLIANCE ln P."""
    part = force / (mu * P)
    return COMPLIANCE * mu * P * ((1.0 - part) * np.log1p(-part) + part)


def test_exact_loops_return_the_parameters() -> None:
    loop = measured(0.8, 1.0e-6)
    fitted = identify.fit(cylinders(), loop, START)
    assert fitted.values == pytest.approx(TRUTH, rel=1e-4)
    gross = Loop.planned(P, 6.0e-3, rows=80, drive="shift", force_noise=1.0e-4)
    (gross,) = identify.simulate(cylinders(61), gross, TRUTH)
    assert gross.tangential_force.max() == pytest.approx(MU * P, rel=1e-9)
    gross.shift += 0.123  # any origin
    fitted = identify.fit(cylinders(61), gross, START)
    assert fitted.values == pytest.approx(TRUTH, rel=1e-4)


def test_loops_of_different_forces_have_one_datum() -> None:
    """A power of 2 is a cylinder, up to a spring in series that is the same for all normal forces (its default datum was not)."""
    loops = []
    for force in (P, 4.0 * P):
        planned = Loop.planned(force, 0.6 * MU * force, shift_noise=1.0e-6)
        loops += identify.simulate(cylinders(), planned, TRUTH)
    power = cylinders()
    power.upper = Body.power(0.5 / RADIUS, 2.0, youngs_modulus=E, poisson_ratio=NU)
    power.mesh, power.steps = Mesh(nodes=61), [Step(normal_force=P)]
    fitted = identify.fit(power, loops, {"friction%mu": 0.6, "rig_stiffness": 3.0e4})
    assert fitted.values["friction%mu"] == pytest.approx(MU, rel=1e-3)
    assert any("give datum" in warning for warning in fitted.warnings)


@pytest.mark.parametrize("priors", [NOTHING_WRONG, Priors(lag=0.2, drift=0.01, offset=0.0)])
def test_standard_errors_are_those_of_the_closed_form(priors: Priors) -> None:
    """With the lag and the drift as unknowns, too: a lag of t shifts a branch by the rate of the shift times t."""
    ratio, nodes = 0.6, 201
    loop = measured(ratio, 0.015, nodes=nodes)
    planned = identify.plan(cylinders(nodes), loop, TRUTH, priors=priors)
    top, force = ratio * MU * P, loop.tangential_force
    is_falling = np.arange(force.size) <= force.size // 2

    def loop_of(mu: float) -> np.ndarray:
        down, up = nonlinear((top - force) / 2.0, mu), nonlinear((top + force) / 2.0, mu)
        end = nonlinear(np.array(top), mu)
        return np.where(is_falling, end - 2.0 * down, 2.0 * up - end)

    step = 1.0e-4
    by_mu = (loop_of(MU + step) - loop_of(MU - step)) / (2.0 * step)
    by_rig = -loop.tangential_force / TRUTH["rig_stiffness"] ** 2
    cycles = np.linspace(-0.5, 0.5, force.size)
    # The rate without that of the nonlinear part comes from the ends of the loop.
    slope = (loop.shift[0] - loop_of(MU)[0] - (loop.shift[100] - loop_of(MU)[100])) / (2.0 * top)
    reversed_by = 0.5 * np.where(is_falling, top - force, top + force)
    rate = np.where(is_falling, -4.0, 4.0) * top * (slope - COMPLIANCE * np.log1p(-reversed_by / (MU * P)))
    columns = [by_mu, by_rig, np.ones_like(by_mu)]
    known = []
    if priors.lag:
        columns += [rate / 360.0, 0.5 * np.ptp(loop.shift) * cycles]
        known = [0.0, 0.0, 0.0, priors.lag**-2, priors.drift**-2]
    used = np.abs(cycles) <= 0.5 - 0.01 + 1e-9 if priors.lag else np.abs(cycles) <= 0.5  # a lag leaves out the ends
    jacobian = np.stack(columns, axis=1)[used] / loop.shift_noise
    covariance = np.linalg.inv(jacobian.T @ jacobian + (np.diag(known) if known else 0.0))[:2, :2]
    np.testing.assert_allclose(list(planned.standard_errors.values()), np.sqrt(np.diag(covariance)), rtol=0.02)
    correlation = covariance[0, 1] / math.sqrt(covariance[0, 0] * covariance[1, 1])
    assert planned.correlation[0, 1] == pytest.approx(correlation, abs=0.02)


def test_intervals_contain_the_truth_as_often_as_they_promise() -> None:
    inside = np.zeros(2)
    for seed in range(30):
        fitted = identify.fit(cylinders(41), measured(0.7, 0.015, seed=seed, nodes=41), START)
        inside += [low <= TRUTH[name] <= high for name in fitted.names for low, high in [fitted.interval(name)]]
    # 95 % of 30 is 28.5; fewer than 26 have a probability of 2 %. examples/identification.py takes 100 seeds.
    assert np.all(inside >= 26)


def test_the_uncertainty_is_predicted_and_a_further_test_reduces_it() -> None:
    small = measured(0.2, 0.015)
    alone = identify.plan(cylinders(), small, TRUTH, priors=NOTHING_WRONG)
    larger = identify.plan(cylinders(), [small, measured(0.8, 0.015)], TRUTH, priors=NOTHING_WRONG)
    slid = Loop.planned(P, 6.0e-3, drive="shift", force_noise=0.015 * MU * P)
    gross = identify.plan(cylinders(), [small, slid], TRUTH)
    relative = [estimate.standard_errors["friction%mu"] / MU for estimate in (alone, larger, gross)]
    assert relative[0] > 0.15 and relative[1] < 0.03 and relative[2] < 0.003
    fitted = identify.fit(cylinders(), measured(0.2, 0.03, seed=1), START)
    (warning,) = [line for line in fitted.warnings if "friction%mu is not determined" in line]
    assert "Q/(mu P)" in warning and "plan" in warning and warning in str(fitted)
    assert not larger.warnings and not gross.warnings


def test_keys_that_only_act_together_are_reported() -> None:
    # At small forces U = Q (constant/E + 1/k) + Q^2/(2 E' mu P): three parameters, two numbers.
    modulus = Axis(["body(1)%youngs_modulus", "body(2)%youngs_modulus"], [E])
    estimate = identify.plan(cylinders(), measured(0.3, 0.001), {**TRUTH, "modulus": modulus})
    assert any("not separated" in line or "not determined" in line for line in estimate.warnings)
    unused = identify.plan(cylinders(), measured(0.5, 0.001), {"friction%mu": MU, "body(2)%yield_strength": 500.0})
    assert math.isinf(unused.standard_errors["body(2)%yield_strength"])
    assert any("body(2)%yield_strength is not determined (the loops do not depend" in line for line in unused.warnings)
    assert unused.standard_errors["friction%mu"] < 0.01


def test_an_amplitude_that_is_too_large_makes_friction_too_large() -> None:
    # A loop opens by COMPLIANCE (Qm^2 - Q^2)/(4 mu P). Least squares over Q with Qm' = 1.02 Qm, in place of Qm, multiply mu by
    # <(Qm'^2 - Q^2)^2>/<(Qm'^2 - Q^2)(Qm^2 - Q^2)> = 1.051.
    loop = measured(0.2, 1.0e-4, nodes=201)
    exact = identify.fit(cylinders(201), loop, START, priors=NOTHING_WRONG).values["friction%mu"]
    loop.tangential_force[[0, 100, 200]] *= 1.02
    loop.shift[[0, 100, 200]] *= 1.02
    ratio = identify.fit(cylinders(201), loop, START, priors=NOTHING_WRONG).values["friction%mu"] / exact
    assert ratio == pytest.approx(1.051, abs=0.01)


@pytest.mark.parametrize("late", [2, 3, 5, 97])
def test_a_record_may_begin_shortly_after_a_turn(late: int) -> None:
    loop = measured(0.6, 0.002, 0.002, seed=3)
    rows = (np.arange(loop.shift.size) + late) % (loop.shift.size - 1)
    later = Loop(loop.tangential_force[rows], loop.shift[rows], P, force_noise=loop.force_noise, shift_noise=loop.shift_noise)
    whole, turned = (identify.fit(cylinders(), each, START, priors=NOTHING_WRONG) for each in (loop, later))
    for key, error in whole.standard_errors.items():
        assert abs(turned.values[key] - whole.values[key]) < error


@pytest.mark.parametrize("shape", ["triangle", "sine"])
def test_levels_of_a_noisy_driven_column_are_unbiased(shape: str) -> None:
    errors_found, claimed = [], []
    phase = np.linspace(0.25, 1.25, 201)
    exact = np.sin(2.0 * np.pi * phase) if shape == "sine" else 2.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * phase))
    for seed in range(60):
        noisy = exact + 0.015 * np.random.default_rng(seed).standard_normal(exact.size)
        path = path_of(Loop(noisy, noisy, P, force_noise=0.015, shift_noise=0.015))
        assert path.levels.size == 2 and np.bincount(path.branch).tolist() == pytest.approx([100, 101], abs=12)
        errors_found.append(np.abs(path.levels) - 1.0)
        claimed.append(path.errors)
    assert abs(np.mean(errors_found)) < 0.2 * 0.015
    assert np.std(errors_found) == pytest.approx(np.mean(claimed), rel=0.3)


def test_noise_is_estimated_from_the_columns() -> None:
    loop = measured(0.6, 0.015, 0.015, seed=3)
    given = (loop.force_noise, loop.shift_noise)
    loop.force_noise = loop.shift_noise = None
    found = loop._prepared()[0]
    assert (found.force_noise, found.shift_noise) == pytest.approx(given, rel=0.2)
    fitted = identify.fit(cylinders(), loop, START)
    assert 0.7 < fitted.chi_squared < 1.4
    assert fitted.loops[0].shift_noise == found.shift_noise


def test_a_wrong_model_is_reported() -> None:
    loop = measured(0.8, 0.002, seed=0)
    scene = cylinders()
    scene.friction = Friction.coulomb(MU)
    fitted = identify.fit(scene, loop, {"rig_stiffness": 1.0e5, "body(2)%radius": 5.0})
    assert not [line for line in fitted.warnings if "does not fit" in line]
    scene.friction = Friction.coulomb(0.8)
    fitted = identify.fit(scene, loop, {"rig_stiffness": 1.0e5})
    assert [line for line in fitted.warnings if "does not fit" in line]
    assert [line for line in fitted.warnings if "correlated" in line]


def test_weakening_friction() -> None:
    scene = cylinders(41)
    scene.friction = Friction.weakening(0.45, 0.3, 3.0e-3)
    truth = {"friction%mu_static": 0.45, "friction%mu_kinetic": 0.3, "friction%weakening_distance": 3.0e-3}
    loop = Loop.planned(P, 8.0e-3, rows=200, drive="shift", force_noise=0.3, cycles_before=0)
    (loop,) = identify.simulate(scene, loop, truth, seed=0)
    fitted = identify.fit(scene, loop, {name: 1.1 * value for name, value in truth.items()})
    for name in truth:
        assert abs(fitted.values[name] - truth[name]) < 3.0 * fitted.standard_errors[name] < 0.03 * truth[name]


def test_posterior_samples_agree_with_the_covariance() -> None:
    loop = measured(0.8, 0.015, seed=5, nodes=41)
    fitted = identify.fit(cylinders(41), loop, START, priors=NOTHING_WRONG)
    samples = fitted.sample(60, walkers=12)
    assert samples.shape == (48 * 12, 2)
    for values, name in zip(samples.T, fitted.names):
        assert np.mean(values) == pytest.approx(fitted.values[name], abs=0.5 * fitted.standard_errors[name])
        assert np.std(values) == pytest.approx(fitted.standard_errors[name], rel=0.35)


def test_tables_and_files(tmp_path: Path) -> None:
    import pandas

    first, second = measured(0.3, 0.01, seed=0), measured(0.6, 0.01, seed=1)
    names = ["low"] * first.shift.size + ["high"] * second.shift.size
    table = pandas.DataFrame(
        {
            "test": names,
            "Q": np.concatenate([first.tangential_force, second.tangential_force]),
            "U": np.concatenate([first.shift, second.shift]),
            "P": P,
        }
    )
    path = tmp_path / "loops.csv"
    path.write_text("# a comment\n" + table.to_csv(index=False))
    for loops in (identify.read(path), identify.loops_of(table, name=str(path))):
        assert [loop.name for loop in loops] == [f"{path}: low", f"{path}: high"]
        np.testing.assert_allclose(loops[1].shift, second.shift, rtol=1e-12)
        assert loops[0].normal_force == P
    fitted = identify.fit(cylinders(), loops, START)
    figure = fitted.figure()
    assert len(figure.axes) == 6 and len(fitted.residuals) == 2
    with pytest.raises(errors.InputError, match="no column P; there are test, Q, U"):
        identify.loops_of(table.drop(columns="P"))


@pytest.mark.parametrize(
    "content, message",
    [
        (b"Q,U,P\n1,1,100\n2,2,\n3,3,100\n4,4,100\n5,5,100\n", " the columns must be finite numbers; remove the rows with gaps"),
        (b"Q,U,P\n1,1,100\n,2,100\n3,3,100\n4,4,100\n5,5,100\n", " the columns must be finite numbers; remove the rows with gaps"),
        (b"Q,U,P\n1,1,100\n2,far,100\n", "3:3: column U: 'far' is not a number"),
        (b"Q,U,P,test\n1,1,100,a\n2,2,100,\n", " column test has empty cells"),
        (b"Q,U,P\n1,1\n", "2: must have 3 cells, as many as the names of the columns, not the 2 of '1,1'"),
        (
            b"Q,U,P\n1,5,2,5,100\n",
            "2: must have 3 cells, as many as the names of the columns, not the 5 of '1,5,2,5,100'; decimal commas need",
        ),
        (b"Q,U,P\n", " no rows; needs a line with the names of the columns"),
        (b"", " no rows; needs a line with the names of the columns"),
        (b"Q,U,P\n1,1,\xb5\n", "2:5: column P: '\xb5' is not a number"),
        (b"Q,U,P\n1,1,\0\n", "2:5: not a text file: control character 0"),
    ],
)
def test_messages_about_a_table_name_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes, message: str
) -> None:
    case, loops = tmp_path / "rig.nml", tmp_path / "loops.csv"
    case.write_text(cylinders().text())
    loops.write_bytes(content)
    with pytest.raises(errors.InputError, match=re.escape(f"{loops}:{message}")):
        identify.read(loops)
    assert main(["identify", str(case), str(loops), "--free", "friction%mu=0.5"]) == 2
    assert capsys.readouterr().err.startswith(f"mfv: {loops}:{message}")


def test_integers_in_a_table(tmp_path: Path) -> None:
    (tmp_path / "loops.csv").write_text(
        "Q, U, P, test  # units: N, mm\n" + "".join(f"{row}, {2 * row}, 100, 7\n" for row in range(5))
    )
    (loop,) = identify.read(tmp_path / "loops.csv")
    assert loop.shift.tolist() == [0.0, 2.0, 4.0, 6.0, 8.0] and loop.normal_force == 100.0 and loop.name.endswith("loops.csv: 7")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case, loops, picture = tmp_path / "rig.nml", PROJECT / "examples" / "loops.csv", tmp_path / "rig.png"
    case.write_text(cylinders(61).text())
    start = [
        "--free",
        "friction%mu=0.5",
        "--free",
        "rig_stiffness=8e4",
        "--shift",
        "large",
        "-o",
        str(picture),
        "--prior",
        "drift=0",
    ]
    assert main(["identify", str(case), str(loops), *start]) == 0
    printed = capsys.readouterr().out
    value = float(re.search(r"^friction%mu +(\S+)", printed, re.MULTILINE)[1])
    assert value == pytest.approx(MU, rel=0.02) and picture.read_bytes()[1:4] == b"PNG"
    for arguments, complaint in (
        ([str(case), str(loops), *start[:2], "--shift", "big"], "no test 'big'; there are small, large"),
        ([str(case), str(loops), *start[:2], "--column", "shift=dU"], "no column du; there are test, U, Q, P"),
        (
            [str(case), str(loops), *start[:2], "--unit", "shift=N"],
            f"{loops}: column U: a value in N is a force and cannot be in mm",
        ),
        (
            [str(case), str(loops), "--free", "mu=0.5"],
            "'mu': no such parameter; free are keys of bodies, friction and mesh, and rig_stiffness; did you mean friction%mu?",
        ),
        ([str(case), str(loops), "--free", "radius=9"], "did you mean body(1)%radius or body(2)%radius?"),
        ([str(case), str(loops), "--free", "friction%mus=9"], "Friction has no 'mus'"),
        ([str(case), str(loops), "--free", "rig_stifness=9"], "did you mean rig_stiffness?"),
        ([str(case), str(case), *start[:2]], f"{case}: no column Q, U, P; there are &scene"),
    ):
        assert main(["identify", *arguments]) == 2
        assert complaint in capsys.readouterr().err
    for arguments, complaint in (
        (["--unit", "U=um"], "argument --unit: 'U' is not the meaning of a column: must be tangential_force, shift,"),
        (["--reverse", "U"], "argument --reverse: 'U' is not the meaning of a column"),
        (["--thickness", "0,8"], "must be a number with a decimal point, such as 0.8, not '0,8'"),
    ):
        with pytest.raises(SystemExit):
            main(["identify", str(case), str(loops), *start[:2], *arguments])
        assert complaint in capsys.readouterr().err
    for option, first, second in (
        ("--free", "friction%mu=0.5", "friction%mu = 0.6"),
        ("--column", "shift=U", "shift=V"),
        ("--unit", "shift=um", "shift=mm"),
        ("--prior", "lag=1", "lag=2"),
    ):
        with pytest.raises(SystemExit):
            main(["identify", str(case), str(loops), "--free", "rig_stiffness=8e4", option, first, option, second])
        assert f"argument {option}: {first.partition('=')[0]} is given twice" in capsys.readouterr().err
    for prior in ("lag=x", "phase=1", "drift=-1"):
        with pytest.raises(SystemExit):
            main(["identify", str(case), str(loops), *start, "--prior", prior])
        assert (
            f"must be NAME=WIDTH such as slack=0.02 with NAME lag, drift, offset, slack, not '{prior}'" in capsys.readouterr().err
        )


def test_errors_name_the_remedy() -> None:
    loop = measured(0.6, 0.01)
    for free, message in (
        ({"friction%nu": 0.3}, "'friction%nu': Friction has no 'nu'"),
        ({"step(1)%shift": 0.3}, "no such parameter"),
        ({"mesh%nodes": 61}, "'mesh%nodes': cannot be estimated, since its values are not real numbers"),
        ({"friction%law": 1.0}, "'friction%law': cannot be estimated"),
        ({"friction%mu": -1.0}, "one positive start value"),
        ({}, "at least one loop and one free parameter"),
        ({"friction%mu": 0.2}, "ends before the last row (loop: "),
    ):
        with pytest.raises(errors.InputError, match=message.replace("(", r"\(").replace(")", r"\)")):
            identify.fit(cylinders(), loop, free)
    with pytest.raises(errors.InputError, match="constant to 5 %"):
        Loop(loop.tangential_force, loop.shift, np.linspace(50.0, 100.0, loop.shift.size))
    with pytest.raises(errors.InputError, match="give shift_noise"):
        identify.plan(cylinders(), Loop.planned(P, 20.0), TRUTH)
    for keys, message in (
        ({"cycles_before": 1.5}, "cycles_before must be a whole number of at least 0"),
        ({"cycles_before": "1"}, "cycles_before must be a whole number of at least 0"),
        ({"shift_noise": "a"}, "force_noise and shift_noise must be numbers of at least 0"),
    ):
        with pytest.raises(errors.InputError, match=message):
            Loop(loop.tangential_force, loop.shift, P, **keys)
    with pytest.raises(errors.InputError, match="at least 5 rows"):
        Loop([1.0, 2.0], [1.0, 2.0], P)


def test_defects_of_rigs_leave_the_truth_inside_or_are_named() -> None:
    """scripts/deep-rigs.sh takes 100 sets of noise; one of each here, triangles and sines by turns."""
    served = 0
    for seed, (name, (rig, words)) in enumerate(DEFECTS.items()):
        count = tried(rig, words, range(seed, seed + 1), nodes=41)
        served += count.served
        assert words not in {"uneven", "spike", "normal force varies", "sign"} or count.named == 1, name
    assert served >= len(DEFECTS) - 2  # of intervals of 95 %, two in each: fewer have a probability of some 3 %


def test_the_sensitivities_are_what_a_lag_and_a_drift_do() -> None:
    scene, without = cylinders(101), Rig(noise=1e-4)
    exact = identify.fit(scene, without.loop(0), TRUTH, priors=NOTHING_WRONG)
    for label, defect in (("0.1 degrees of lag", {"lag": 0.1}), ("0.1 % of drift", {"drift": 0.001})):
        changed = identify.fit(scene, Rig(noise=1e-4, **defect).loop(0), TRUTH, priors=NOTHING_WRONG)
        for name, sensitivity in exact.sensitivities[label].items():
            assert changed.values[name] / exact.values[name] - 1.0 == pytest.approx(sensitivity, rel=0.1)
        assert f"{label}, if not estimated, would change friction%mu by {exact.sensitivities[label]['friction%mu']:+.2%}" in str(
            exact
        )
    assert exact.sensitivities["0.1 degrees of lag"]["friction%mu"] == pytest.approx(-0.032, abs=0.004)


def test_a_play_is_an_unknown_if_asked_for() -> None:
    loop = Rig(slack=0.02).loop(0)
    fitted = identify.fit(cylinders(), loop, START)
    (warning,) = [line for line in fitted.warnings if "slack (play)" in line]
    assert "not included in the fit: give priors=Priors(slack=0.04)" in warning
    fitted = identify.fit(cylinders(), loop, START, priors=Priors(slack=0.04))
    (found,) = [each for each in fitted.rig_errors if each.name == "slack"]
    assert abs(found.value - 0.02) < 3.0 * found.standard_error < 0.012
    error = fitted.standard_errors["rig_stiffness"]
    assert abs(fitted.values["rig_stiffness"] - TRUTH["rig_stiffness"]) < 3.0 * error < 0.15 * TRUTH["rig_stiffness"]
    assert any("it is included in the fit" in line for line in fitted.warnings)


def test_rows_at_random_times() -> None:
    """With the times the extremes are known as those of evenly spaced rows; without them, from the rows near them."""
    widths = {}
    for with_time in (True, False):
        loop = Rig(uneven=True, with_time=with_time).loop(3)
        path = path_of(loop)
        assert path.sampling == ("time" if with_time else "arc length")
        assert np.all(np.abs(np.abs(path.levels) / (0.7 * MU * P) - 1.0) < 4.0 * path.errors / (0.7 * MU * P) + 1e-12)
        widths[with_time] = path.errors.max()
    assert widths[True] < 0.005 * 0.7 * MU * P < widths[False] < 0.02 * 0.7 * MU * P
    estimated = Rig(uneven=True, noise_is_given=False).loop(3)
    assert path_of(estimated).noise == pytest.approx((0.005 * 0.7 * MU * P, 0.005 * np.ptp(estimated.shift) / 2.0), rel=0.3)


def test_the_zero_of_the_force_is_found_where_the_contact_slides() -> None:
    loop = Loop.planned(P, 6.0e-3, rows=100, drive="shift", force_noise=0.005 * MU * P)
    (loop,) = identify.simulate(cylinders(41), loop, TRUTH, seed=1)
    loop.tangential_force += 0.03 * MU * P
    fitted = identify.fit(cylinders(41), loop, START)
    (found,) = [each for each in fitted.rig_errors if each.name == "offset"]
    assert abs(found.value - 0.03) < 3.0 * found.standard_error < 0.006
    assert abs(fitted.values["friction%mu"] - MU) < 3.0 * fitted.standard_errors["friction%mu"] < 0.01 * MU
    assert any("the zero of the force is offset" in line for line in fitted.warnings)


def test_an_interval_may_have_no_upper_limit() -> None:
    """At 0.2 mu P, with an unknown lag, mu may be as large as you like: the loop need not be wider than its lag makes it."""
    fitted = identify.fit(cylinders(), Rig(ratio=0.2, noise=0.01).loop(0), START)
    low, high = fitted.interval("friction%mu")
    assert 0.2 * MU < low < MU and math.isinf(high)
    assert any(f"95 % interval from {low:.3g} on" in line for line in fitted.warnings)
    low, high = fitted.interval("rig_stiffness")
    assert low < TRUTH["rig_stiffness"] < high


def test_what_a_column_shows_by_itself() -> None:
    varying = Rig(varying=0.04).loop(0)
    assert varying.normal_force_variation == pytest.approx(0.04, rel=0.1)
    noisy = Loop(varying.tangential_force, varying.shift, P + 2.0 * np.random.default_rng(0).standard_normal(varying.shift.size))
    assert noisy.normal_force_variation == 0.0
    spiky = np.full(varying.shift.size, P)
    spiky[[20, 90]] = (0.0, 4.0 * P)
    assert Loop(varying.tangential_force, varying.shift, spiky).normal_force == P
    path = path_of(Rig(spikes=4).loop(2))
    assert path.is_spike.sum() == 4 and "4 spikes" in path.warnings[0]
    digital = path_of(Rig(bits=8).loop(0))
    step = 1.3 * 2.0 * 0.7 * MU * P / 256.0
    assert digital.noise[0] == pytest.approx(math.hypot(0.005 * 0.7 * MU * P, step / math.sqrt(12.0)), rel=0.05)
    assert not path_of(Rig().loop(0)).warnings
    reversed_shift = Rig(wrong_sign=True).loop(0)
    fitted = identify.fit(cylinders(), reversed_shift, START)
    np.testing.assert_array_equal(fitted.loops[0].shift, -reversed_shift.shift)


def test_wrong_priors_and_times_are_refused() -> None:
    loop = measured(0.6, 0.01)
    for time in (np.zeros(loop.shift.size), np.arange(3.0), np.full(loop.shift.size, np.nan)):
        with pytest.raises(errors.InputError, match=f"time must have {loop.shift.size} finite numbers that increase"):
            Loop(loop.tangential_force, loop.shift, P, time=time)
    for width in (-1.0, math.nan, math.inf, "1", True):
        with pytest.raises(errors.InputError, match="lag=.*: the width of a prior must be a finite number of at least 0"):
            Priors(lag=width)


def test_a_published_loop() -> None:
    """Fouvry, Arnaud, Mignot and Neubauer 2017 (Tribology International 113, 460-473), the reference condition (docs/identify.md).

    The dissipation of the fitted loop, which is not used for the fit, is the published one to 6 %."""
    titanium = {"youngs_modulus": 119e3, "poisson_ratio": 0.29}  # MPa
    scene = Scene(Body.half_plane(**titanium), Body.disk(80.0, **titanium), friction=Friction.coulomb(1.0), mesh=Mesh(nodes=61))
    most, end, slid = 0.625 * 1066.0, 0.1225, 0.075  # N/mm, mm
    loop = Loop(
        np.array([most, 0.0, -most, 0.0, most]), np.array([end, slid, -end, -slid, end]), 1066.0, "shift", 0.025 * 1066.0, 0.0
    )
    fitted = identify.fit(scene, loop, {"friction%mu": 0.8, "rig_stiffness": 2e4})
    assert 0.6 < fitted.values["friction%mu"] < 0.65
    force, shift = np.concatenate(fitted.curves[0], axis=1)
    dissipation = abs(float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(shift)))) * 8.0 * 1e-3  # 8 mm long, J
    assert dissipation == pytest.approx(1.54, rel=0.06)
    assert isinstance(fitted, mfv.identify.Fit)
