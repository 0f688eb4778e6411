"""What goes wrong in the first hour: the message says what to write, and what it says works."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mfv

ROOT = Path(__file__).resolve().parents[2]
RUN = os.environ.get("MFV_RUN", str(ROOT / "build/release/bin/mfv_run"))
PAD = """&body shape='half_plane', youngs_modulus=74100, poisson_ratio=0.33 /
&body shape='disk', radius=127, youngs_modulus=74100, poisson_ratio=0.33 /
"""
PRESS = "&step normal_force=500 /\n"


def run(folder: Path, text: str) -> subprocess.CompletedProcess[str]:
    """mfv_run on a case."""
    (folder / "case.nml").write_text(text)
    return subprocess.run([RUN, "case.nml"], cwd=folder, capture_output=True, text=True)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PAD + "&friction mu=0.5 /\n" + PRESS, "case.nml:3: &friction mu=0.5: needs a law; add law='coulomb'"),
        (PAD + "&friction mu_file='mu.txt' /\n" + PRESS, "&friction mu_file='mu.txt': needs a law; add law='coulomb'"),
        (PAD + "&friction stiffness=1e3 /\n" + PRESS, "&friction stiffness=1e3: needs a law; add law='dahl'"),
        (
            PAD + "&friction weakening_distance=1e-3 /\n" + PRESS,
            "&friction weakening_distance=1e-3: needs a law; add law='weakening'",
        ),
        (PAD + "&friction law='none', mu=0.5 /\n" + PRESS, "has no effect with law='none'; remove it or choose another law"),
        (PAD + PRESS + "&step tangential_force=50 /\n", "needs a &friction law with a coefficient above 0"),
        (PAD + "&step normal_force=1,5e2 /\n", "one value expected, found 2; write decimals with a point"),
        (PAD + "&step normal_force=500,5 /\n", "one value expected, found 2; write decimals with a point"),
        (PAD + "&step normal_force=500 N /\n", "one value expected, found 2; write numbers without units"),
        (PAD + "&step normal_force=500 N/mm /\n", "and the / before it ended &step (write numbers without units"),
        (
            PAD.replace("'disk', radius=127", "'profile', file=data/scan.txt") + PRESS,
            "ended &body (write numbers without units, texts with /",
        ),
        (PAD + "&step normal_force=500 # pressed\n/\n", "one value expected, found 3; a comment begins with !"),
        (PAD + "&friction law='coulomb', mu=0.5 # dry\n/\n" + PRESS, "must be a number at least 0; a comment begins with !"),
        (PAD + "&friction law=coulomb, mu=0.5 /\n" + PRESS, "law=coulomb: must be 'none', 'coulomb', 'static_kinetic', "),
        (PAD + "&friction law=coulomb, mu=0.5 /\n" + PRESS, "'weakening' or 'dahl', between quotes"),
        ("&sweep base='pad.nml' /\n", "&sweep: unknown group; this is a study: solve it with 'mfv study'"),
        (PAD + "&step normal_force=500, cycles=2 x /\n", "one value expected, found 2; write numbers without units"),
    ],
)
def test_the_message_says_what_to_write(text: str, message: str, tmp_path: Path) -> None:
    done = run(tmp_path, text)
    assert done.returncode == 2 and message in done.stderr, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["case.nml"]


def test_a_neat_pin_is_the_limit_of_small_clearances(tmp_path: Path) -> None:
    """The normals that the message asks for are taken; a clearance of 1e-9 of the radius changes the contact by less than 1e-4."""
    pin = """&body shape='hole', radius={radius}, youngs_modulus=70000, poisson_ratio=0.33 /
&body shape='disk', radius=10, youngs_modulus=210000, poisson_ratio=0.3 /
&mesh {mesh} /
&step normal_force=200 /
"""
    done = run(tmp_path, pin.format(radius=10, mesh="nodes=101"))
    assert done.returncode == 2 and "is that of the disk in it; such a neat fit needs normals='radial'" in done.stderr
    neat, nearly = (
        mfv.run(text=pin.format(radius=radius, mesh=f"normals='radial', {mesh}"), check=True).summary.contact_half_width
        for radius, mesh in (("10", "nodes=202"), ("10.00000001", "nodes=101, half_angle=90"))
    )
    assert neat == pytest.approx(nearly, rel=1e-4) and neat > 10.0


@pytest.mark.parametrize(("scale", "is_named"), [("", True), (", height_scale=1e-3", False)])
def test_heights_in_another_unit_are_suspected(scale: str, is_named: bool, tmp_path: Path) -> None:
    """A scan with positions in mm and heights in micrometres: a finer mesh is not the remedy."""
    x = np.linspace(-1.0, 1.0, 401)
    heights = 50.0 * x**2 + 3.0 * np.sin(20.0 * x) + 0.3 * np.sin(90.0 * x)
    np.savetxt(tmp_path / "scan.txt", np.column_stack((x, heights)))
    upper = f"&body shape='profile', file='scan.txt'{scale}, rigid=.true. /\n"
    done = run(tmp_path, PAD.splitlines()[0] + "\n" + upper + "&mesh nodes=200, half_width=0.9 /\n&step normal_force=100 /\n")
    warnings = [line for line in done.stdout.splitlines() if line.startswith("warning")]
    assert any("check height_scale of the upper body, whose heights change by" in line for line in warnings) == is_named, (
        done.stdout
    )


@pytest.mark.parametrize(
    "heading", ["x [mm],z [um]", "Position [mm],Height [\N{MICRO SIGN}m]", '"x (mm)","z (\N{GREEK SMALL LETTER MU}m)"']
)
def test_a_heading_with_different_units_needs_a_scale(heading: str, tmp_path: Path) -> None:
    x = np.linspace(-1.0, 1.0, 41)
    rows = "\n".join(f"{a:.3f},{a * a:.5f}" for a in x)
    (tmp_path / "scan.csv").write_text(f"{heading}\n{rows}\n", encoding="utf-8")
    case = PAD.splitlines()[0] + "\n&body shape='profile', file='scan.csv'{}, rigid=.true. /\n&step normal_force=100 /\n"
    done = run(tmp_path, case.format(""))
    assert done.returncode == 2
    assert "by its heading positions are in mm and heights in um; give height_scale=0.001 if lengths are in mm" in done.stderr
    assert run(tmp_path, case.format(", height_scale=1e-3")).returncode == 0
    (tmp_path / "scan.csv").write_text(f"x [mm],z [mm]\n{rows}\n")
    assert run(tmp_path, case.format("")).returncode == 0
