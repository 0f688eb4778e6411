"""A fretting pad in CalculiX on finer and finer meshes, and MFV's sub-model under the loads of each: tractions, stick zone, slip, times.

PYTHONPATH=python build/venv/bin/python bench/finite_element_pad.py [--folder build/pad] [--divisions 4 8 16 32]

Writes the table whose numbers docs/from_fe.md has; the last columns compare tractions and stresses with those of MFV under the loads of the first mesh. Needs the
program ccx (Debian: calculix-ccx). Files of the runs stay in the folder.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("MFV_LIBRARY", str(ROOT / "build/release/lib/libmfv.so"))

from mfv import Body, Friction, Mesh, Output, Result, Scene, stress
from mfv.finite_elements import ContactLoads, from_fe
from mfv.finite_elements.deck import read_deck
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
#: Times of the model between which slip is measured; the second one is the end.
TURN, END = 3.0, 4.0
#: Tractions are compared at this distance from the edges and beyond [mm].
EDGE = 0.03
#: Stresses beside the contact are compared between these distances from it [mm].
BESIDE = (0.06, 1.5)
#: A node sticks below this share of mu p.
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
    """The result on a mesh, its number of elements, and the processor's seconds that it took. Raises RuntimeError if ccx fails."""
    text, elements = deck(HALF_WIDTH / divisions)
    name = f"pad{divisions}"
    result, clock = folder / f"{name}.frd", folder / f"{name}.seconds"
    if (folder / f"{name}.inp").is_file() and (folder / f"{name}.inp").read_text() == text and clock.is_file():
        return result, elements, float(clock.read_text())
    clock.unlink(missing_ok=True)
    (folder / f"{name}.inp").write_text(text)
    start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start
    if run.returncode or "Job finished" not in run.stdout:
        raise RuntimeError(f"ccx failed: {run.stdout[-500:]}")
    clock.write_text(f"{seconds:.3f}")
    return result, elements, seconds


def trimmed(result: Path, folder: Path) -> None:
    """Write a result with the surfaces' nodes at the ends of the steps only, its deck with these nodes and their sets, and the resultants."""
    deck_of = read_deck(result.with_suffix(".inp"))
    names = ("UPPER_SURFACE", "LOWER_SURFACE")
    kept = {number for name in names for number in deck_of.numbers(name)}
    lines = ["** Nodes of the surfaces of a pad, by bench/finite_element_pad.py", "*NODE"]
    lines += [f"{number},{deck_of.nodes[number][0]:.12g},{deck_of.nodes[number][1]:.12g}" for number in sorted(kept)]
    for name in names:
        lines += [f"*NSET, NSET={name}", *(str(number) for number in deck_of.numbers(name))]
        lines += [f"*SURFACE, NAME={name}, TYPE=NODE", name]
    (folder / "pad.inp").write_text("\n".join(lines) + "\n")
    (folder / "pad.frd").write_text("".join(_trimmed_blocks(result, kept)))
    text = result.with_suffix(".dat").read_text()
    parts = re.split(r"(?=^ statistics for slave set)", text, flags=re.MULTILINE)
    times = [float(match[1]) if (match := re.search(r"and time\s+(\S+)", part)) else 0.5 for part in parts]
    (folder / "pad.dat").write_text("".join(part for part, time in zip(parts, times) if time % 1.0 == 0.0))


def _trimmed_blocks(result: Path, kept: set[int]) -> Iterator[str]:
    """The lines of a .frd file with stresses and contact tractions of some nodes at whole times."""
    head, *blocks = re.split(r"(?=^    1PSTEP)", result.read_text(), flags=re.MULTILINE)
    wanted = [block for block in blocks if re.search(r"^ -4  (STRESS|CONTACT) ", block, re.MULTILINE)]
    of_node = re.compile(r"^ -1 *(\d+)")
    elements = re.compile(r"^    3C.*?^ -3\n", re.MULTILINE | re.DOTALL)
    for part in [elements.sub("", head), *(block for block in wanted if float(block.splitlines()[1][12:24]) % 1.0 == 0.0)]:
        for line in part.splitlines(keepends=True):
            number = of_node.match(line[:13])
            if number is None or int(number[1]) in kept:
                yield line
    yield " 9999\n"


# --- answers ---


def of_elements(result: Path) -> Answer:
    """The answer of the finite elements."""
    contact, slip = read_surface(result, "UPPER_SURFACE"), read_surface(result, "UPPER_SURFACE", columns={"shear": "CSLIP1"})
    below = read_surface(result, "LOWER_SURFACE")
    pressure, shear = contact.fields["pressure"], contact.fields["shear"]
    turn, end = (int(np.argmin(np.abs(contact.times - time))) for time in (TURN, END))
    moved = slip.fields["shear"][end] - slip.fields["shear"][turn]
    along = below.fields["stress_xx"][end]
    largest = int(np.argmax(along))
    return Answer(
        float(np.abs(shear[end]).max()),
        stick_zone(contact.position[:, 0], pressure[end], shear[end]),
        float(along[largest]),
        float(below.position[largest, 0]),
        slip_range(pressure[turn], pressure[end], moved),
    )


def stick_zone(x: Array, pressure: Array, shear: Array) -> tuple[float, float]:
    """The ends of the longest row of nodes that stick, by their tractions; NaN if none does."""
    sticks = (pressure > 1e-3 * pressure.max()) & (np.abs(shear) < STICKS * MU * pressure)
    places = np.nonzero(sticks)[0]
    row = max(np.split(places, np.nonzero(np.diff(places) > 1)[0] + 1), key=len)
    return (float(x[row[0]]), float(x[row[-1]])) if len(row) else (np.nan, np.nan)


def slip_range(before: Array, after: Array, moved: Array) -> float:
    """The largest slip from one state to another at nodes in contact in both."""
    both = (before > 1e-3 * before.max()) & (after > 1e-3 * after.max())
    return float(np.abs(moved[both]).max())


def of_sub_model(loads: ContactLoads, nodes: int) -> tuple[Answer, Result, float]:
    """The answer and result of MFV under loads of the finite elements, and the processor's seconds that it took."""
    alloy = {"youngs_modulus": YOUNG, "poisson_ratio": POISSON}
    bodies = Body.half_plane(**alloy), Body.disk(RADIUS, elasticity="half_plane", **alloy)
    scene = Scene(
        *bodies,
        mesh=Mesh(nodes=nodes, refine="edges"),
        friction=Friction.coulomb(MU),
        steps=loads.steps(),
        output=Output(states="steps", history="steps"),
    )
    start = time.process_time()
    result = scene.run(check=True)
    seconds = time.process_time() - start
    times = loads.t[loads.loaded]
    turn, end = (result.steps[int(np.argmin(np.abs(times - time)))] for time in (TURN, END))
    moved = np.array(end.slip) - np.array(turn.slip)
    answer = Answer(
        float(np.abs(end.shear).max()),
        stick_zone(np.array(result.mesh.x), np.array(end.pressure), np.array(end.shear)),
        float(result.observables.lower_tension),
        float(result.observables.lower_tension_x),
        slip_range(np.array(turn.pressure), np.array(end.pressure), moved),
    )
    return answer, result, seconds


def differences(of_mesh: Path, result: Result) -> tuple[float, float]:
    """Root mean squares of the differences of pressure and shear at the nodes of the finite elements, except the outermost ones at each edge,
    from those of MFV, over the largest pressure, at the end."""
    contact = read_surface(of_mesh, "UPPER_SURFACE")
    end = int(np.argmin(np.abs(contact.times - END)))
    x, nodes, state = contact.position[:, 0], np.array(result.mesh.x), result.state
    edge = min(-float(result.summary.contact_left), float(result.summary.contact_right)) - EDGE
    inside, largest = np.abs(x) < edge, float(np.max(state.pressure))
    found = []
    for name in ("pressure", "shear"):
        off = contact.fields[name][end] - np.interp(x, nodes, np.array(state[name]))
        found.append(float(np.sqrt(np.mean(off[inside] ** 2))) / largest)
    return found[0], found[1]


def stress_difference(of_mesh: Path, result: Result) -> float:
    """The largest difference of the stress along the specimen's surface from that of MFV at nodes beside the contact, at the end."""
    below = read_surface(of_mesh, "LOWER_SURFACE")
    x, edge = below.position[:, 0], max(-float(result.summary.contact_left), float(result.summary.contact_right))
    beside = (np.abs(x) > edge + BESIDE[0]) & (np.abs(x) < edge + BESIDE[1])
    end = int(np.argmin(np.abs(below.times - END)))
    field = stress.stress(result, x[beside], np.full(int(beside.sum()), -1e-9 * SIZE))
    return float(np.max(np.abs(below.fields["stress_xx"][end, beside] - field["sigma_xx"])))


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=ROOT / "build/pad")
    parser.add_argument("--divisions", type=int, nargs="+", default=[4, 8, 16, 32], help="elements across half the contact")
    parser.add_argument("--nodes", type=int, default=201, help="nodes of MFV")
    parser.add_argument(
        "--trimmed", type=Path, metavar="FOLDER", help="write the surfaces of the first mesh as examples/fe_pad has them"
    )
    options = parser.parse_args(arguments)
    if shutil.which("ccx") is None:
        print("skipped: the program ccx (CalculiX) is not installed; in Debian it is in the package calculix-ccx")
        return 0
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.trimmed:
        trimmed(solved(options.folder, options.divisions[0])[0], options.trimmed)
        return 0
    print(
        "| model | elements or nodes | seconds | P | Q | bulk stress | peak shear | stick zone | tension | at x | slip range, um | p, q off, % | stress off |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    first: Result | None = None
    for divisions in options.divisions:
        result, elements, seconds = solved(options.folder, divisions)
        loads = from_fe(result, "UPPER_SURFACE", opposite="LOWER_SURFACE", centre=0.0)
        assert loads.lower_bulk is not None
        bulk = f"{loads.lower_bulk.stress[-1]:.2f} +- {loads.lower_bulk.error[-1]:.2f}"
        carried = f"{loads.P[-1]:.2f} | {loads.Q[-1]:.2f} | {bulk}"
        answer, solution, spent = of_sub_model(loads, options.nodes)
        first = first or solution
        off = " ".join(f"{100.0 * part:.1f}" for part in differences(result, first))
        off += f" | {stress_difference(result, first):.1f}"
        print(f"| CalculiX a/{divisions} | {elements} | {seconds:.1f} | {carried} | {shown(of_elements(result))} | {off} |")
        print(f"| MFV under its loads | {options.nodes} | {spent:.2f} | | | | {shown(answer)} | | |", flush=True)
    return 0


def shown(answer: Answer) -> str:
    left, right = answer.stick
    return (
        f"{answer.peak_shear:.2f} | {left:.3f} to {right:.3f} | {answer.tension:.1f} | {answer.tension_x:.3f} | "
        f"{1e3 * answer.slip_range:.3f}"
    )


if __name__ == "__main__":
    sys.exit(main())
