"""The programs of examples/hosts, built on an installed tree (MFV_HOSTS: where), against closed forms and against each other."""

from __future__ import annotations

import csv
import importlib.util
import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mfv

ROOT = Path(__file__).resolve().parents[2]
HOSTS = Path(os.environ["MFV_HOSTS"])
NEWMARK = HOSTS / "newmark"

_spec = importlib.util.spec_from_file_location("draw_newmark", ROOT / "examples" / "hosts" / "draw_newmark.py")
decay = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(decay)

#: Options of one large time step from rest under a sudden force.
LARGE_STEP = ["--amplitude", "0", "--force", "0.5", "--steps", "1", "--periods", "1", "--verbose"]
#: Motions of the mass, with and without coupling of pressure and shear.
VARIANTS = ([], ["--normal"], ["--poisson-ratio", "0"], ["--normal", "--poisson-ratio", "0"])


def output(program: str, *options: str, **environment: str) -> str:
    """What a program prints."""
    command = [str(HOSTS / program), *options]
    return subprocess.run(command, env=os.environ | environment, check=True, capture_output=True, text=True).stdout


def energy(table: dict[str, np.ndarray]) -> np.ndarray:
    """All of it, dissipated or not."""
    return table["kinetic"] + table["potential"] + table["dissipation"]


# Cylinder


def test_cylinders_in_c_and_fortran_say_what_the_package_says():
    text = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 / &body shape='disk', radius=0.25, rigid=.true. /
    &mesh nodes=101, half_width=0.0125 / &friction law='coulomb', mu=0.7 /
    &step normal_force=1.0e-3, friction=.false. / &step tangential_force=2.8e-4 /"""
    result = mfv.run(text=text)
    summary = result.summary
    expected = f"nodes in contact {summary.contact_nodes}, stuck {summary.stick_nodes}\nshift {summary.shift:.6E}\n"
    expected += f"dissipation {summary.dissipation:.6E}\npeak shear {result.state.shear.max():.6E}\n"
    assert output("cylinder_c") == expected
    assert output("cylinder_fortran") == expected


# Parameter study


@pytest.fixture(scope="module")
def study() -> str:
    return output("openmp_study", OMP_NUM_THREADS="1")


@pytest.mark.parametrize("threads", ["2", "8"])
def test_study_has_the_same_bytes_whatever_the_threads(study, threads):
    assert output("openmp_study", OMP_NUM_THREADS=threads) == study


def test_study_has_a_row_for_every_case(study):
    rows = list(csv.DictReader(io.StringIO(study)))
    assert len(rows) == 45
    for row in rows:
        slides = float(row["force_ratio"]) > 1
        assert row["outcome"] == ("gross sliding" if slides else "complete")
        assert np.isnan(float(row["cycle_dissipation"])) == slides
        assert float(row["contact_half_width"]) > 0


def test_study_is_mindlin_where_nothing_couples(study):
    checked = 0
    for row in csv.DictReader(io.StringIO(study)):
        ratio, mu = float(row["force_ratio"]), float(row["friction"])
        if float(row["dundurs_beta"]) > 0 or ratio > 1:
            continue
        half_width = mfv.reference.hertz_half_width(5.0e-4, 0.25, 1.0, 1.0)
        exact = mfv.reference.mindlin_dissipation(ratio * mu * 5.0e-4, 5.0e-4, half_width, 0.25, mu)
        # 62 nodes in contact, of which 4 slip on either side at the least ratio
        assert float(row["cycle_dissipation"]) == pytest.approx(exact, rel=0.05 if ratio < 0.3 else 0.02)
        assert float(row["stick_ratio_return"]) == pytest.approx(np.sqrt(1 - ratio), abs=0.01)
        checked += 1
    assert checked == 12


# A mass on a contact: Newton


def test_newton_converges_quadratically():
    """r(k+1)/r(k)^2 is bounded until no node changes its status any more; what is left then is linear, and the next iterate exact."""
    _, newton = decay.simulate(NEWMARK, *LARGE_STEP, "--nodes", "1001")
    residual = newton["residual"]
    assert len(residual) == 5
    assert np.all(residual[1:4] / residual[:3] ** 2 < 0.5)
    order = np.log(residual[3] / residual[2]) / np.log(residual[2] / residual[1])
    assert order == pytest.approx(2.0, abs=0.15)
    assert residual[4] < 1e-14


def test_initial_stiffness_converges_linearly():
    _, newton = decay.simulate(NEWMARK, *LARGE_STEP)
    _, initial = decay.simulate(NEWMARK, *LARGE_STEP, "--initial-stiffness")
    assert len(newton["residual"]) - 1 <= 4 < 15 <= len(initial["residual"]) - 1
    rates = initial["residual"][3:] / initial["residual"][2:-1]
    assert np.all(rates > 0.15) and rates.max() < 1.05 * rates.min()


@pytest.mark.parametrize("options", VARIANTS, ids=" ".join)
def test_tangent_is_exact_between_events(options):
    """An iterate that passes no event beyond the one before it solves a linear equation: its residual is round-off."""
    _, table = decay.simulate(NEWMARK, *options, "--verbose", "--amplitude", "0.8", "--steps", "20", "--periods", "3")
    step, iteration, residual, events = (table[name] for name in ("step", "iteration", "residual", "events"))
    same = (iteration[1:] > 1) & (events[1:] == events[:-1])
    assert same.sum() >= 20
    # Of two free motions the way there changes with the iterate, and with it the slip where the normal force changes on that way.
    assert residual[1:][same].max() < (1e-5 if "--normal" in options else 1e-12)
    assert len(residual) / step.max() < 5


# A mass on a contact: energy, decay, time steps


@pytest.mark.parametrize("options", VARIANTS, ids=" ".join)
def test_energy_is_balanced_to_second_order(options):
    """Newmark's work is the force by the trapezoidal rule, which misses Q'' dU^3/12 a step: order 2 over a time."""
    defects = []
    for steps in (25, 50, 100):
        table, _ = decay.simulate(NEWMARK, *options, "--steps", str(steps), "--periods", "3")
        total, dissipated = energy(table), np.ptp(table["dissipation"])
        defects.append(np.ptp(total) / dissipated)
    assert defects[2] < 2e-3
    # A mean over two halvings: where the motion turns within its time step makes each one irregular.
    assert np.log2(defects[0] / defects[2]) / 2 == pytest.approx(2.0, abs=0.15)


def test_newmark_conserves_what_the_trapezoidal_rule_says():
    """Kinetic energy changes by the mean force times the way, to the tolerance of the iteration."""
    table, _ = decay.simulate(NEWMARK, "--steps", "25", "--periods", "2")
    force, shift, kinetic = table["tangential_force"], table["shift"], table["kinetic"]
    work = np.diff(shift) * (force[1:] + force[:-1]) / 2
    assert np.abs(np.diff(kinetic) + work).max() < 1e-10 * kinetic.max()


def test_half_swings_dissipate_what_quasi_static_cycles_do():
    """Trials taken back leave no trace: the dissipation is that of cycles with the same forces, on the same mesh to round-off."""
    amplitude, nodes = 0.8, 101
    table, _ = decay.simulate(NEWMARK, "--amplitude", str(amplitude), "--nodes", str(nodes), "--periods", "3")
    turns = decay.turning_points(table)
    lost, half_ranges = np.diff(turns["dissipation"]), np.abs(np.diff(turns["tangential_force"])) / 2
    assert len(lost) == 5
    for energy_lost, force in zip(lost.tolist(), half_ranges.tolist()):
        assert quasi_static_dissipation(force, nodes) / 2 == pytest.approx(energy_lost, rel=1e-9)
        assert decay.dissipation(force) / 2 == pytest.approx(energy_lost, rel=5e-3)


def quasi_static_dissipation(force: float, nodes: int) -> float:
    """Of a cycle between +-force of the contact of newmark.c."""
    text = f"""&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.5 / &body shape='disk', radius=0.25, rigid=.true. /
    &mesh nodes={nodes}, half_width={1.3 * decay.HALF_WIDTH!r}, gap='parabolic' / &friction law='coulomb', mu=0.7 /
    &step normal_force=1.0e-3, friction=.false. / &step tangential_force={force!r} /
    &step tangential_force={-force!r}, cycles=1 /"""
    return mfv.run(text=text).observables.cycle_dissipation


@pytest.mark.parametrize("amplitude", [0.8, 0.2])
def test_amplitudes_fall_as_quasi_static_dissipation_tells(amplitude):
    """Turning points against those of Mindlin's dissipation: errors of the time step, of order 2, and of the mesh."""
    errors = []
    for steps in (20, 80):
        options = ["--amplitude", str(amplitude), "--nodes", "201", "--steps", str(steps), "--periods", "4"]
        table, _ = decay.simulate(NEWMARK, *options)
        turns = decay.turning_points(table)
        forces, shifts = decay.predicted_turns(amplitude * decay.LIMIT, len(turns["time"]))
        assert len(forces) >= 8
        errors.append(max(np.abs(turns["tangential_force"] / forces - 1).max(), np.abs(turns["shift"] / shifts - 1).max()))
    assert errors[1] < 1e-3 and errors[1] < errors[0] / 6


def test_small_amplitudes_fall_hyperbolically():
    """1/Q grows by 1/(3 mu P ln(2 d/a)) a swing, the nearer the smaller the amplitude."""
    rate = 1 / (3 * decay.LIMIT * np.log(2 * decay.DATUM / decay.HALF_WIDTH))
    deviations = []
    for amplitude in (0.1, 0.05, 0.025):
        forces, _ = decay.predicted_turns(amplitude * decay.LIMIT, 21)
        deviations.append((1 / abs(forces[-1]) - 1 / forces[0]) / 10 / rate - 1)
    assert 0 < deviations[-1] < 0.02 and deviations[0] > 1.7 * deviations[1] > 2.9 * deviations[2]
    table, _ = decay.simulate(NEWMARK, "--amplitude", "0.2", "--nodes", "201", "--periods", "4")
    force = np.abs(decay.turning_points(table)["tangential_force"])
    assert (1 / force[6] - 1 / force[0]) / 3 / rate == pytest.approx(1.09, abs=0.02)


def test_time_steps_converge_with_the_second_order():
    tables = [decay.simulate(NEWMARK, "--steps", str(steps), "--periods", "3")[0] for steps in (25, 50, 100)]
    shifts = [table["shift"][:: 2**i] for i, table in enumerate(tables)]
    coarse, fine = (np.linalg.norm(shifts[i] - shifts[i + 1]) for i in (0, 1))
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.1)


def test_options_are_checked():
    for options, message in ((["--nodes", "x"], "'x' is not a number"), (["--nonsense"], "usage:"), (["1"], "usage:")):
        done = subprocess.run([str(NEWMARK), *options], capture_output=True, text=True)
        assert done.returncode == 2 and message in done.stderr and done.stdout == ""


def test_the_mesh_grows_with_the_contact():
    command = [str(NEWMARK), "--normal", "--force", "10", "--poisson-ratio", "0"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0 and len(done.stdout.splitlines()) > 500 and done.stderr == ""


def test_picture(tmp_path):
    picture = tmp_path / "decay.png"
    command = [sys.executable, str(ROOT / "examples" / "hosts" / "draw_newmark.py"), str(NEWMARK), "-o", str(picture)]
    subprocess.run(command, check=True)
    assert picture.read_bytes().startswith(b"\x89PNG")
