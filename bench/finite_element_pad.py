"""A fretting pad in CalculiX on finer and finer meshes, and MFV's sub-model under the loads of each: tractions, stick zone, slip, tension, times.

PYTHONPATH=python build/venv/bin/python bench/finite_element_pad.py [--folder build/pad] [--divisions 4 8 16 32]

Writes the rows of the table in docs/from_fe.md. Needs the program ccx (Debian: calculix-ccx). Files of the runs stay in the folder.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("MFV_LIBRARY", str(ROOT / "build/release/lib/libmfv.so"))

from mfv import Body, Friction, Mesh, Output, Scene
from mfv.finite_elements import ContactLoads, from_fe
from mfv.finite_elements.readers import read_surface

Array = NDArray[np.float64]

#: The pad: radius, half-width and height of both bodies [mm], aluminium [N/mm^2].
RADIUS, SIZE, YOUNG, POISSON, MU = 75.0, 8.0, 74000.0, 0.33, 0.75
#: Hertz's half-width under the normal force [mm], by which the mesh is measured; the fine mesh extends over 1.4 of it.
HALF_WIDTH, FINE, GROWTH = 0.567, 1.4, 1.25
#: Displacements of the top of the pad (down, sideways) and of the ends of the specimen [mm].
DOWN, ASIDE, STRETCH = 0.0071, 0.0034, 0.004
#: Increments of the four steps: press, shear and stretch, the same back, and forward again; the last two are a cycle.
INCREMENTS = (4, 10, 20, 20)
#: Penalty stiffnesses [N/mm^3].
NORMAL_PENALTY, STICK_PENALTY = 1.0e8, 1.0e7
#: A node of the finite elements sticks below this share of mu p.
STICKS = 0.98


class Answer(NamedTuple):
    """What is compared, at the end of the history: peak shear [N/mm^2], stick zone [mm], tension and where it is; slip range [mm]."""

    peak_shear: float
    stick: tuple[float, float]
    tension: float
    tension_x: float
    slip_range: float


# --- the model ---


def positions(spacing: float) -> Array:
    """x of the columns of nodes: equal over the contact, growing beyond."""
    count = int(np.ceil(FINE * HALF_WIDTH / spacing))
    x = [spacing * at for at in range(count + 1)]
    step = spacing
    while x[-1] < SIZE:
        step *= GROWTH
        x.append(x[-1] + step)
    beyond = np.array(x[count:]) - x[count]
    right = np.concatenate([x[:count], x[count] + beyond * (SIZE - x[count]) / beyond[-1]])
    return np.concatenate([-right[:0:-1], right])


def depths(spacing: float) -> Array:
    """Distances of the rows of nodes from the surface: equal over half the contact, growing beyond."""
    count = int(np.ceil(0.5 * HALF_WIDTH / spacing))
    y, step = [spacing * at for at in range(count + 1)], spacing
    while y[-1] < SIZE:
        step *= GROWTH
        y.append(y[-1] + step)
    return np.array(y) * SIZE / y[-1]


def deck(spacing: float) -> tuple[str, int]:
    """The input deck, and its number of elements."""
    x, depth = positions(spacing), depths(spacing)
    shape = (len(x), len(depth))
    lower = np.arange(1, x.size * depth.size + 1).reshape(shape)
    upper = lower + lower.size
    gap = x**2 / (2.0 * RADIUS)
    height = gap[:, None] + depth[None, :] * (SIZE - gap[:, None]) / SIZE
    lines = ["*NODE"]
    lines += [f"{lower[i, j]},{x[i]:.12g},{-depth[j]:.12g}" for i in range(shape[0]) for j in range(shape[1])]
    lines += [f"{upper[i, j]},{x[i]:.12g},{height[i, j]:.12g}" for i in range(shape[0]) for j in range(shape[1])]
    of_lower, of_upper = _elements(lower, 0, is_upper=False), _elements(upper, (shape[0] - 1) * (shape[1] - 1), is_upper=True)
    for name, rows, side in (("LOWER", of_lower, "S3"), ("UPPER", of_upper, "S1")):
        lines += [f"*ELEMENT, TYPE=CPE4, ELSET={name}", *(",".join(map(str, row)) for row in rows)]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=ALUMINIUM", "1."]
        surface = rows[:: shape[1] - 1]
        lines += [f"*SURFACE, NAME={name}_SURFACE", *(f"{row[0]},{side}" for row in surface)]
    sets = {"BASE": lower[:, -1], "TOP": upper[:, -1], "LEFT": lower[0], "RIGHT": lower[-1]}
    for name, nodes in sets.items():
        lines += [f"*NSET, NSET={name}", *(str(node) for node in nodes)]
    lines += ["*MATERIAL, NAME=ALUMINIUM", "*ELASTIC", f"{YOUNG},{POISSON}"]
    lines += ["*SURFACE INTERACTION, NAME=FRICTION", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{NORMAL_PENALTY:g},1."]
    lines += ["*FRICTION", f"{MU:g},{STICK_PENALTY:g}"]
    lines += ["*CONTACT PAIR, INTERACTION=FRICTION, TYPE=SURFACE TO SURFACE", "UPPER_SURFACE,LOWER_SURFACE"]
    for increments, way in zip(INCREMENTS, (0.0, 1.0, -1.0, 1.0)):
        lines += _step(increments, way)
    return "\n".join(lines) + "\n", len(of_lower) + len(of_upper)


def _elements(nodes: NDArray[np.int64], before: int, *, is_upper: bool) -> list[list[int]]:
    """Number and nodes, counterclockwise, of the elements of a body; `before`: number of those of the other one."""
    rows = []
    for i in range(nodes.shape[0] - 1):
        for j in range(nodes.shape[1] - 1):
            left, right = (nodes[i, j], nodes[i, j + 1]), (nodes[i + 1, j], nodes[i + 1, j + 1])
            around = [left[0], right[0], right[1], left[1]] if is_upper else [left[1], right[1], right[0], left[0]]
            rows.append([before + len(rows) + 1, *map(int, around)])
    return rows


def _step(increments: int, way: float) -> list[str]:
    fixed = [f"TOP,2,2,{-DOWN}", "BASE,2,2", f"TOP,1,1,{way * ASIDE}", f"LEFT,1,1,{-way * STRETCH}", f"RIGHT,1,1,{way * STRETCH}"]
    files = ["*NODE FILE", "U", "*EL FILE", "S", "*CONTACT FILE", "CDIS,CSTR"]
    printed = ["*CONTACT PRINT, SLAVE=UPPER_SURFACE, MASTER=LOWER_SURFACE", "CF"]
    increment = 1.0 / increments
    return ["*STEP, INC=1000", "*STATIC", f"{increment},1.,1e-6,{increment}", "*BOUNDARY", *fixed, *files, *printed, "*END STEP"]


def solved(folder: Path, divisions: int) -> tuple[Path, int, float]:
    """The result on a mesh, its number of elements, and the seconds that it took. Raises RuntimeError if ccx fails."""
    text, elements = deck(HALF_WIDTH / divisions)
    name = f"pad{divisions}"
    result, clock = folder / f"{name}.frd", folder / f"{name}.seconds"
    if (folder / f"{name}.inp").is_file() and (folder / f"{name}.inp").read_text() == text and clock.is_file():
        return result, elements, float(clock.read_text())
    clock.unlink(missing_ok=True)
    (folder / f"{name}.inp").write_text(text)
    start = time.perf_counter()
    run = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    seconds = time.perf_counter() - start
    if run.returncode or "Job finished" not in run.stdout:
        raise RuntimeError(f"ccx failed: {run.stdout[-500:]}")
    clock.write_text(f"{seconds:.3f}")
    return result, elements, seconds


# --- answers ---


def of_elements(result: Path) -> Answer:
    """The answer of the finite elements."""
    contact, slip = read_surface(result, "UPPER_SURFACE"), read_surface(result, "UPPER_SURFACE", columns={"shear": "CSLIP1"})
    below = read_surface(result, "LOWER_SURFACE")
    x, pressure, shear = contact.position[:, 0], contact.fields["pressure"], contact.fields["shear"]
    touches = pressure[-1] > 1e-3 * pressure[-1].max()
    sticks = x[touches & (np.abs(shear[-1]) < STICKS * MU * pressure[-1])]
    turn = int(np.argmin(np.abs(contact.times - 3.0)))
    both = touches & (pressure[turn] > 1e-3 * pressure[turn].max())
    moved = np.abs(slip.fields["shear"][-1] - slip.fields["shear"][turn])[both]
    stress = below.fields["stress_xx"][-1]
    largest = int(np.argmax(stress))
    edges = (float(sticks.min()), float(sticks.max())) if len(sticks) else (np.nan, np.nan)
    return Answer(
        float(np.abs(shear[-1]).max()), edges, float(stress[largest]), float(below.position[largest, 0]), float(moved.max())
    )


def of_sub_model(loads: ContactLoads, nodes: int) -> tuple[Answer, float]:
    """The answer of MFV under loads of the finite elements, and the seconds that it took."""
    alloy = {"youngs_modulus": YOUNG, "poisson_ratio": POISSON}
    bodies = Body.half_plane(**alloy), Body.disk(RADIUS, elasticity="half_plane", **alloy)
    scene = Scene(
        *bodies,
        mesh=Mesh(nodes=nodes),
        friction=Friction.coulomb(MU),
        steps=loads.steps(),
        output=Output(states="steps", history="steps"),
    )
    start = time.perf_counter()
    result = scene.run(check=True)
    seconds = time.perf_counter() - start
    turn = result.steps[int(np.argmin(np.abs(loads.t[loads.loaded] - 3.0)))]
    touches = (np.array(turn.pressure) > 0.0) & (np.array(result.state.pressure) > 0.0)
    moved = np.abs(np.array(result.state.slip) - np.array(turn.slip))[touches]
    stick = float(result.summary.stick_left), float(result.summary.stick_right)
    observed = result.observables
    peak = float(np.abs(result.state.shear).max())
    return Answer(peak, stick, float(observed.lower_tension), float(observed.lower_tension_x), float(moved.max())), seconds


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=ROOT / "build/pad")
    parser.add_argument("--divisions", type=int, nargs="+", default=[4, 8, 16, 32], help="elements across half the contact")
    parser.add_argument("--nodes", type=int, default=201, help="nodes of MFV")
    options = parser.parse_args(arguments)
    if shutil.which("ccx") is None:
        print("skipped: the program ccx (CalculiX) is not installed; in Debian it is in the package calculix-ccx")
        return 0
    options.folder.mkdir(parents=True, exist_ok=True)
    print(
        "| model | elements or nodes | seconds | P | Q | bulk stress | peak shear | stick zone | tension | at x | slip range, um |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for divisions in options.divisions:
        result, elements, seconds = solved(options.folder, divisions)
        loads = from_fe(result, "UPPER_SURFACE", opposite="LOWER_SURFACE")
        assert loads.lower_bulk is not None
        bulk = f"{loads.lower_bulk.stress[-1]:.2f} +- {loads.lower_bulk.error[-1]:.2f}"
        carried = f"{loads.P[-1]:.2f} | {loads.Q[-1]:.2f} | {bulk}"
        print(f"| CalculiX a/{divisions} | {elements} | {seconds:.1f} | {carried} | {shown(of_elements(result))} |")
        answer, seconds = of_sub_model(loads, options.nodes)
        print(f"| MFV under its loads | {options.nodes} | {seconds:.2f} | | | | {shown(answer)} |", flush=True)
    return 0


def shown(answer: Answer) -> str:
    left, right = answer.stick
    return (
        f"{answer.peak_shear:.2f} | {left:.3f} to {right:.3f} | {answer.tension:.1f} | {answer.tension_x:.3f} | "
        f"{1e3 * answer.slip_range:.3f}"
    )


if __name__ == "__main__":
    sys.exit(main())
