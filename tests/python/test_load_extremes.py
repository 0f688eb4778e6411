"""Extremes over the last cycle, the rows of a history or the steps, against the saved states of the same case."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scenes import seeds

import mfv
from mfv.stress import stress

PROJECT = Path(__file__).resolve().parents[2]
#: The largest stresses are searched for in the states in which estimates are largest.
CHOICE = 1.0e-3


def case(seed: int, output: str = "states='reversals'", finer: int = 1) -> tuple[str, int, bool]:
    """A random load history in rows, some of them cycles, with a normal force that varies and a bulk stress out of phase; the number of
    its rows, and whether it is repeated. `finer`: rows for each, in equal parts."""
    random = np.random.default_rng(seed)
    rows, mu, force = int(random.integers(6, 12)), random.uniform(0.2, 0.9), random.uniform(200.0, 1500.0)
    phase = 2.0 * np.pi * np.arange(rows + 1) / rows
    normal = force * (1.0 + (0.3 * np.sin(phase) if seed % 2 else 0.0 * phase))
    shear = mu * force * random.uniform(0.3, 0.6) * np.sin(phase + (0.0 if seed % 4 < 2 else np.pi))
    bulk = random.uniform(50.0, 300.0) * (1.0 - np.cos(phase))
    loads = np.array([normal, shear, bulk])
    every = np.arange(1, rows * finer + 1) / finer
    columns = [", ".join(f"{value:.9g}" for value in np.interp(every, np.arange(rows + 1), load)) for load in loads]
    repeated = seed % 3 == 0
    return (
        f"""&scene length_unit='mm', force_unit='N' /
&body shape='half_plane', youngs_modulus=2.1e5, poisson_ratio=0.3, yield_strength=1e6 /
&body shape='disk', radius={random.uniform(20, 60):.4g}, rigid=.true. /
&mesh nodes={int(random.integers(80, 140))} /
&friction law='coulomb', mu={mu:.4g} /
&step normal_force={force:.9g} /
&history normal_force={columns[0]}, tangential_force={columns[1]}, lower_bulk_stress={columns[2]}{", cycles=2" if repeated else ""} /
&output history='steps', {output} /
""",
        rows * finer,
        repeated,
    )


def last_states(result: mfv.Result, rows: int) -> list[int]:
    """Numbers, from 1, of the states of the rows, or of the last cycle."""
    return list(range(len(result.steps) - rows + 1, len(result.steps) + 1))


@pytest.mark.parametrize("seed", seeds(8))
def test_extremes_are_those_of_the_states(seed: int) -> None:
    text, rows, repeated = case(seed)
    result = mfv.run(text=text)
    numbers, seen = last_states(result, rows), result.observables
    states = [result.steps[number - 1] for number in numbers]

    pressures = np.array([state.pressure.max() for state in states])
    assert seen.largest_pressure == pressures.max() and seen.largest_pressure_row == 1 + np.argmax(pressures)
    state = states[int(np.argmax(pressures))]
    assert state.pressure[np.argmin(np.abs(result.mesh.x - seen.largest_pressure_x))] == pytest.approx(pressures.max(), rel=1e-3)
    # Between nodes at edges of stick zones, so not below the nodes.
    shear = np.max([np.abs(state.shear).max() for state in states])
    assert shear <= seen.largest_shear <= 1.1 * shear
    ratios = np.array([state.stick_ratio for state in states])
    assert seen.smallest_stick_ratio == pytest.approx(ratios.min(), rel=1e-9)
    assert seen.largest_stick_ratio == pytest.approx(ratios.max(), rel=1e-9)
    assert ratios[int(seen.smallest_stick_ratio_row) - 1] == pytest.approx(ratios.min(), rel=1e-9)

    slip = np.array([np.where(state.status > 0, state.slip, np.nan) for state in states])
    touched = np.any(np.isfinite(slip), axis=0)
    ranges = np.nanmax(slip[:, touched], axis=0) - np.nanmin(slip[:, touched], axis=0)
    assert seen.largest_slip_range == pytest.approx(ranges.max(), rel=1e-9)
    assert ranges[np.argmin(np.abs(result.mesh.x[touched] - seen.largest_slip_range_x))] == pytest.approx(ranges.max(), rel=1e-9)

    fields = [stress(result, 0.0, 0.0, step=number) for number in numbers]
    tensions = np.array([field.tension.value for field in fields])
    assert seen.largest_lower_tension == pytest.approx(tensions.max(), rel=CHOICE)
    row = int(seen.largest_lower_tension_row)
    assert seen.largest_lower_tension == pytest.approx(tensions[row - 1], rel=1e-4)
    assert seen.largest_lower_tension_x == pytest.approx(fields[row - 1].tension.x, rel=1e-3)
    assert seen.largest_lower_tension > seen.lower_tension * (1.0 - 1e-9)
    # On the surface the stress has cusps, which the coarser elements of this search flatten.
    mises = fields[int(seen.largest_lower_von_mises_row) - 1].largest.value
    assert seen.largest_lower_von_mises == pytest.approx(mises, rel=0.04)
    if repeated:
        for name in ("largest_lower_tension", "largest_pressure", "largest_shear", "largest_slip_range"):
            assert result.cycles[name][-1] == seen[name], name


@pytest.mark.parametrize("seed", seeds(4))
def test_extremes_need_no_saved_states_and_do_not_fall_with_more_rows(seed: int) -> None:
    seen = mfv.run(text=case(seed)[0]).observables
    unsaved = mfv.run(text=case(seed, "states='none'")[0]).observables
    finer = mfv.run(text=case(seed, "states='none'", finer=2)[0]).observables
    for name in ("largest_lower_tension", "largest_pressure", "largest_shear", "largest_slip_range", "largest_stick_ratio"):
        assert unsaved[name] == seen[name], name
        assert finer[name] >= (1.0 - CHOICE) * seen[name], name


@pytest.mark.parametrize("seed", seeds(2))
def test_the_summary_has_the_cycle_before_the_end(seed: int, tmp_path: Path) -> None:
    """Out of phase, the tension at the end of the cycle is a fraction of the largest one."""
    result = mfv.run(text=case(3 * seed, "states='none'")[0])
    assert result.observables.largest_lower_tension > 1.5 * result.observables.lower_tension
    (tmp_path / "case.nml").write_text(case(3 * seed, "states='none'")[0])
    program = os.environ.get("MFV_RUN", str(PROJECT / "build/release/bin/mfv_run"))
    text = subprocess.run([program, "case.nml"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert text.index("over the last cycle: lower body") < text.index("tension at the end")
    assert re.search(rf"\(row {int(result.observables.largest_lower_tension_row)}\)", text)


@pytest.mark.parametrize("seed", seeds(3))
def test_stress_along_the_surface_in_every_row(seed: int) -> None:
    text, rows, _ = case(seed, "states='reversals', stress_at=-0.3")
    result = mfv.run(text=text)
    history = result.history
    for number in last_states(result, rows)[::3]:
        field = stress(result, -0.3, 0.0, step=number)
        record = number  # a record for the start, then one for every state
        assert history.lower_surface_stress[record] == pytest.approx(field["sigma_xx"].item(), rel=1e-6, abs=1e-6 * 100)
        assert history.lower_tension[record] == pytest.approx(field.tension.value, rel=1e-4)
    assert "upper_tension" not in history
    events = mfv.run(text=text.replace("history='steps'", "history='events'")).history
    ends = events.event_kind == mfv.EventKind.STEP_END
    assert np.array_equal(np.isfinite(events.lower_surface_stress), ends)


@pytest.mark.parametrize("seed", seeds(2))
def test_yield_in_a_row_that_is_not_saved(seed: int) -> None:
    largest = mfv.run(text=case(seed, "states='none'")[0]).observables
    text = case(seed, "states='none'")[0].replace("1e6", f"{0.99 * largest.largest_lower_von_mises:.9g}")
    warnings = mfv.run(text=text).attributes["warnings"]
    assert "exceeds its yield_strength" in warnings and "of &history" in warnings
    text = text.replace(f"{0.99 * largest.largest_lower_von_mises:.9g}", f"{1.5 * largest.largest_lower_von_mises:.9g}")
    assert "yield" not in mfv.run(text=text).attributes["warnings"]
