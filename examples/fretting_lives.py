"""Predicted lives of published fretting-fatigue tests over the measured ones.

    python examples/fretting_lives.py [-o PICTURE.png] [--nodes N]

Every test is solved with its bulk stress; five multiaxial parameters are read at the hot spot and, by critical distances, below it, and
strain-life curves of the alloys give the life to initiation. Nothing is fitted. Then follows what becomes of short cracks under pads of
the sizes between which the lives of the Al-4Cu tests become infinite. docs/fatigue.md has the findings; the files in
examples/fatigue_tests say where the numbers come from.
"""

from __future__ import annotations

import argparse
import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Output, Scene, Step, fatigue

TESTS = Path(__file__).resolve().parent / "fatigue_tests"

# Constants of the materials are from memory too, not checked against print.
#: Al-4Cu in fully reversed loading, Araujo and Nowell (1999): threshold of long cracks, N/mm^(3/2), and the range of the fatigue limit, MPa.
THRESHOLD, LIMIT_RANGE = 4.2 * math.sqrt(1000.0), 248.0
CRITICAL_LENGTH = fatigue.critical_length(THRESHOLD, LIMIT_RANGE)
SHORT_CRACK_LENGTH = fatigue.critical_length(THRESHOLD, LIMIT_RANGE, geometry_factor=1.1215)


#: k of these parameters for fatigue limits in torsion and bending in the ratio of von Mises, since those of the alloys are not at hand.
RATIO = 1.0 / math.sqrt(3.0)
FINDLEY, CROSSLAND, DANG_VAN = (
    constant(1.0, RATIO) for constant in (fatigue.findley_constant, fatigue.crossland_constant, fatigue.dang_van_constant)
)

#: The hot spot, and the methods of critical distances.
PLACES = ("hot spot", "point", "area", "line")


@dataclass(frozen=True)
class Alloy:
    """What a series was made of. `curve`: strain-life, with its source below."""

    name: str
    youngs_modulus: float
    mu: float
    yield_strength: float
    curve: fatigue.StrainLife


POISSON = 0.33
ALLOYS = {
    # Curve of 2024-T4 (SAE J1099), the alloy of 4.5 % copper nearest to HE15-TF; moduli, mu and yield of Araujo and Nowell (1999).
    "al_4cu": Alloy("Al-4Cu", 74000.0, 0.75, 465.0, fatigue.StrainLife(74000.0, 1015.0, -0.11, 0.21, -0.52, POISSON)),
    # Curve of 2024-T351 from Szolwinski and Farris (1998), Wear 221, 24.
    "al_2024_t3": Alloy("2024-T3", 72100.0, 0.65, 325.0, fatigue.StrainLife(72100.0, 714.0, -0.078, 0.166, -0.538, POISSON)),
}


@dataclass(frozen=True)
class Prediction:
    """A test and the lives of its predictions by parameter and place."""

    series: str
    half_width: float
    measured: float
    failed: bool
    lives: dict[str, float]


def rows(path: Path) -> list[dict[str, str]]:
    """The rows of a file of tests."""
    return list(csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")))


def solved(alloy: Alloy, row: dict[str, str], nodes: int) -> mfv.Result:
    """A test: pressed, then two cycles of shear and bulk stress in phase."""
    radius = float(row["pad_radius"])
    if "normal_force" in row:
        force = float(row["normal_force"])
        shear = float(row["tangential_force"])
    else:  # Hertz: P = pi a p0/2, a = 2 R p0/E*, E* of two equal bodies
        pressure, contact_modulus = float(row["peak_pressure"]), 0.5 * alloy.youngs_modulus / (1.0 - POISSON**2)
        force = math.pi * radius * pressure**2 / contact_modulus
        shear = float(row["force_ratio"]) * force
    bulk, shear_ratio, bulk_ratio = (float(row[key]) for key in ("bulk_stress", "shear_load_ratio", "bulk_load_ratio"))
    elastic = {"youngs_modulus": alloy.youngs_modulus, "poisson_ratio": POISSON}
    return Scene(
        Body.half_plane(**elastic),
        Body.disk(radius, **elastic),
        friction=Friction.coulomb(alloy.mu),
        mesh=Mesh(nodes=nodes),
        steps=[
            Step(normal_force=force, friction=False),
            Step(tangential_force=shear, lower_bulk_stress=bulk),
            Step(tangential_force=shear_ratio * shear, lower_bulk_stress=bulk_ratio * bulk, cycles=2),
        ],
        output=Output(history="none"),
    ).run(check=True)


def lives(alloy: Alloy, result: mfv.Result, places: tuple[str, ...] = PLACES) -> dict[str, float]:
    """Lives by every parameter at the places, by "parameter, place"."""
    hot_spot = mfv.stress.stress(result, 0.0, 0.0).tension.x
    curve, strength = alloy.curve, {"yield_strength": alloy.yield_strength}
    found = {}
    for place in places:
        if place == "hot spot":
            cycle = fatigue.stress_cycle(result, hot_spot, 0.0)
        else:
            cycle = fatigue.averaged_cycle(result, hot_spot, CRITICAL_LENGTH, method=place)
        for name, parameter, of_test in (
            ("SWT", fatigue.smith_watson_topper(cycle), curve.smith_watson_topper),
            ("FS", fatigue.fatemi_socie(cycle, **strength), lambda n: curve.fatemi_socie(n, **strength)),
            ("Findley", fatigue.findley(cycle, k=FINDLEY), lambda n: curve.findley(n, k=FINDLEY)),
            ("Crossland", fatigue.crossland(cycle, k=CROSSLAND), lambda n: curve.crossland(n, k=CROSSLAND)),
            ("Dang Van", fatigue.dang_van(cycle, k=DANG_VAN), lambda n: curve.dang_van(n, k=DANG_VAN)),
        ):
            found[f"{name}, {place}"] = float(fatigue.life(parameter.maximum.value, of_test))
    return found


def predictions(name: str, nodes: int) -> list[Prediction]:
    """All tests of a file."""
    found = []
    for row in rows(TESTS / f"{name}.csv"):
        result = solved(ALLOYS[name], row, nodes)
        half_width = float(result.summary.contact_half_width)
        found.append(Prediction(row["series"], half_width, float(row["life"]), row["failed"] == "yes", lives(ALLOYS[name], result)))
    return found


def report(name: str, tests: list[Prediction]) -> None:
    """Print the tests of a series, and how well each parameter does."""
    shown = ("SWT, hot spot", "FS, hot spot", "SWT, point", "FS, point")
    print(f"\n{name}: predicted over measured life (run-outs: predicted life in brackets)")
    print("series  a, mm  measured  " + "  ".join(f"{key:>13}" for key in shown))
    for test in tests:
        values = (
            f"{test.lives[key] / test.measured:13.2f}" if test.failed else f"{f'({test.lives[key]:.1e})':>13}" for key in shown
        )
        print(f"{test.series:6}  {test.half_width:.3f}  {test.measured:8.2e}  " + "  ".join(values))
    failed = [test for test in tests if test.failed]
    print(f"{len(failed)} failed tests: number within a factor of 2 and of 5, median of predicted over measured life")
    print(f"{'':10}" + "".join(f"{place:>20}" for place in PLACES))
    for parameter in ("SWT", "FS", "Findley", "Crossland", "Dang Van"):
        cells = []
        for place in PLACES:
            ratios = np.array([test.lives[f"{parameter}, {place}"] / test.measured for test in failed])
            counts = [int(np.sum(np.abs(np.log(ratios)) <= math.log(factor))) for factor in (2.0, 5.0)]
            cells.append(f"{counts[0]}, {counts[1]}, {np.median(ratios):.2g}")
        print(f"{parameter:10}" + "".join(f"{cell:>20}" for cell in cells))


def critical_sizes(nodes: int) -> None:
    """Pads of the largest size that survived and of the smallest that failed: what each criterion has to distinguish."""
    alloy = ALLOYS["al_4cu"]
    print(
        "\nAl-4Cu, pads that survived / failed: the criterion holds if its values in all series lie to either side of one limit (1 for cracks)"
    )
    print(
        "series  FS life at the critical distance     Ruiz sigma tau delta [N^2/mm^3]  crack: smallest range/threshold, full and opening"
    )
    for row in rows(TESTS / "al_4cu_critical_sizes.csv"):
        values: list[tuple[float, ...]] = []
        for radius in (row["largest_radius_survived"], row["smallest_radius_failed"]):
            test = {**row, "pad_radius": radius, "shear_load_ratio": "-1", "bulk_load_ratio": "-1"}
            result = solved(alloy, test, nodes)
            hot_spot = mfv.stress.stress(result, 0.0, 0.0).tension.x
            length = np.geomspace(1.0e-3, 6.0 * float(result.summary.contact_half_width), 50)
            crack = fatigue.edge_crack(result, hot_spot, length)
            threshold = fatigue.short_crack_threshold(length, THRESHOLD, SHORT_CRACK_LENGTH)
            ratios = [float(np.min(ranges / threshold)) for ranges in (crack.range, crack.opening_range)]
            values.append((lives(alloy, result, ("point",))["FS, point"], float(np.max(fatigue.ruiz(result).second)), *ratios))
        (a, b, c, d), (e, f, g, h) = values
        print(
            f"{row['series']:6}  {a:12.1e} / {e:<12.1e}         {b:12.1f} / {f:<12.1f}     {c:8.2f} / {g:.2f}  {d:8.2f} / {h:.2f}"
        )


def draw(found: dict[str, list[Prediction]], path: str) -> None:
    """Predicted over measured lives at the hot spot and at the critical distance; lives over the size of the contact."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(12.5, 4.2), layout="constrained")
    ends = np.array([3.0e3, 6.0e9])
    markers = {"al_4cu": "o", "al_2024_t3": "s"}
    for ax, place in zip(axes, ("hot spot", "point")):
        ax.fill_between(ends, ends / 5.0, ends * 5.0, color="0.93", label="factor 5")
        ax.fill_between(ends, ends / 2.0, ends * 2.0, color="0.82", label="factor 2")
        for name, tests in found.items():
            for parameter, colour in (("SWT", "tab:blue"), ("FS", "tab:orange")):
                for failed in (True, False):
                    chosen = [(test.measured, test.lives[f"{parameter}, {place}"]) for test in tests if test.failed is failed]
                    label = f"{ALLOYS[name].name}, {parameter}" if failed else None
                    face = colour if failed else "none"
                    ax.plot(*zip(*chosen) if chosen else ((), ()), markers[name], color=colour, markerfacecolor=face, label=label)
        ax.set(
            xscale="log", yscale="log", xlim=(5e4, 3e7), ylim=ends, xlabel="measured life, cycles", ylabel="predicted life, cycles"
        )
        where = "at the hot spot" if place == "hot spot" else f"at L/2 = {0.5 * CRITICAL_LENGTH:.3f} mm below it"
        ax.set_title(f"{where} (open: run-outs)", fontsize=10)
    axes[0].legend(fontsize=8, loc="upper left")
    for series, colour in (("1", "tab:red"), ("3", "tab:green")):
        tests = [test for test in found["al_4cu"] if test.series == series]
        width = [test.half_width for test in tests]
        axes[2].semilogy(width, [test.lives["FS, point"] for test in tests], "-", color=colour, label=f"series {series}, at L/2")
        axes[2].semilogy(
            width, [test.lives["FS, hot spot"] for test in tests], "--", color=colour, label=f"series {series}, hot spot"
        )
        for failed in (True, False):
            chosen = [(test.half_width, test.measured) for test in tests if test.failed is failed]
            axes[2].plot(*zip(*chosen), "o" if failed else "^", color=colour, markerfacecolor=colour if failed else "none")
    axes[2].set(xlabel="half-width of the contact, mm", ylabel="life, cycles", ylim=(3e4, 5e8))
    axes[2].set_title("Al-4Cu, Fatemi-Socie (triangles: run-outs)", fontsize=10)
    axes[2].legend(fontsize=8)
    figure.suptitle("Measured lives from memory of the published tables, not checked against print", fontsize=9)
    figure.savefig(path, dpi=120)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="picture")
    parser.add_argument("--nodes", type=int, default=101, help="nodes of the mesh (101)")
    options = parser.parse_args()
    found = {name: predictions(name, options.nodes) for name in ALLOYS}
    for name, tests in found.items():
        report(ALLOYS[name].name, tests)
    critical_sizes(options.nodes)
    if options.output:
        draw(found, options.output)


if __name__ == "__main__":
    main()
