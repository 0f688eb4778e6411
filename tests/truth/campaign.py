"""Many problems: the record of each, and the table of all."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from typing import Any

import numpy as np

import mfv
from mfv import errors

from .generate import describe, problem
from .problem import Problem
from .relations import relations
from .truth import FINER, truth_of
from .verdict import GROUPS, RIGHT, WORDS, flagged_quantities, judge, public_name

#: Relations tried with one problem.
RELATIONS_OF_ONE = 2
#: Largest certificate of a complete run without a warning; iterations and laws with a tolerance have a larger one.
CERTIFICATE = 1.0e-8
#: Nodes of the truth beyond which a run would be given up (MOST_WORK) after a few increments.
MOST_NODES = 30_000
#: More nodes than this in contact are needed for a problem to be ordinary.
ORDINARY_NODES = 30


def record(seed: int) -> dict[str, Any]:
    """What became of the problem of a seed."""
    return record_of(problem(seed), seed)


def record_of(made: Problem, seed: int) -> dict[str, Any]:
    """What became of a problem: its fate, verdicts by quantity, differences by relation.

    Fates: refused; judged; too long; ended alike; ends early (only on the problem's own mesh); goes on (only there); no limit (results
    with static and kinetic friction do not converge with the mesh); meshes disagree (the two fine ones); mesh too narrow (the
    contact becomes four times as wide as a given half-width, which it does sooner with wide intervals); too stiff (on one of the
    meshes it ends with the message that these bristles are too stiff for it, and how stiff they may be).
    """
    found: dict[str, Any] = {"seed": seed, **describe(made), "fate": "judged", "verdicts": {}, "relations": {}}
    try:
        base = made.run()
    except errors.InputError as error:
        return {**found, "fate": "refused", "message": str(error)}
    found["outcome"], found["nodes"] = base.outcome, len(base.mesh.x)
    found["ordinary"] = made.ordinary and int(base.summary.contact_nodes) > ORDINARY_NODES
    found["warnings"] = base.attributes.get("warnings", "")
    if base.outcome == "interrupted":
        return {**found, "fate": "too long"}
    if base.outcome == "complete" and base.summary.largest_residual > CERTIFICATE and "residual" not in found["warnings"]:
        found["relations"]["certificate"] = {"largest": float(base.summary.largest_residual)}
    if found["law"] != "static_kinetic":
        found["relations"].update(_related(made, base, seed))
        try:
            _judge(made, base, found)
        except errors.InputError as error:
            return {**found, "fate": "refused", "message": str(error)}
    else:
        found["fate"] = "no limit"
    return found


def _related(made: Problem, base: mfv.Result, seed: int) -> dict[str, dict[str, float]]:
    """What differs in some relations. Quantities flagged as not resolved may differ by up to RIGHT where the problem is restated."""
    patterns = flagged_quantities(base)

    def counts(name: str, path: str, difference: float) -> bool:
        restated = name not in ("Python", "program") and path.split("/")[0] in GROUPS
        flagged = restated and any(re.fullmatch(pattern, public_name(path)) for pattern in patterns)
        return difference > RIGHT or not flagged

    possible = relations(made, base, seed)
    names = list(np.random.default_rng(seed + 1).permutation(list(possible)))[:RELATIONS_OF_ONE]
    found = {}
    for name in names:
        try:
            found[str(name)] = {path: difference for path, difference in possible[name]().items() if counts(name, path, difference)}
        except (errors.MfvError, RuntimeError) as error:
            found[str(name)] = {f"error: {error}": math.inf}
    return found


def _judge(made: Problem, base: mfv.Result, found: dict[str, Any]) -> None:
    if FINER[0] * len(base.mesh.x) > MOST_NODES:
        found["fate"] = "too long"
        return
    truth = truth_of(made, base)
    fine = (truth.coarser.outcome, truth.finer.outcome)
    found["fine outcomes"] = fine
    if "interrupted" in fine:
        found["fate"] = "too long"
    elif any("bristles are too stiff" in result.message for result in (base, *truth[:2])):
        found["fate"] = "too stiff"
    elif fine[0] != fine[1]:
        found["fate"] = "meshes disagree"
    elif base.outcome == "mesh exceeded" and made.has("mesh", "half_width"):
        found["fate"] = "mesh too narrow"
    elif base.outcome != fine[0]:
        found["fate"] = "ends early" if fine[0] == "complete" else "goes on" if base.outcome == "complete" else "ends otherwise"
        found["message"] = base.message
    elif base.outcome != "complete":
        found["fate"] = "ended alike"
    else:
        found["verdicts"] = {path: tuple(verdict) for path, verdict in judge(made, base, truth).items()}
        found["holds"] = {path: verdict.holds for path, verdict in judge(made, base, truth).items() if verdict.holds is not None}


def findings(one: dict[str, Any]) -> list[str]:
    """What a record has found: quantities, relations with what differs, fates."""
    found = [path for path, verdict in one["verdicts"].items() if verdict[0] == "finding"]
    found += [f"{name}: {path}" for name, paths in one["relations"].items() for path in paths]
    if one["fate"] in ("ends early", "goes on", "ends otherwise"):
        found.append(one["fate"])
    return found


#: Rows of the table: quantities by name, the first that matches counts.
FAMILIES = {
    "extremes over the last cycle or history": r"(largest|smallest)_.*|stick_ratio_(lowest|highest)",
    "edges of the contact, number of patches": r"contact_(half_width|left|right|length|centre)|half_width_number|patches",
    "stick zones": r"(edge_)?stick_(ratio|left|right|length|zones)",
    "peak pressure": r"peak_pressure|pressure_number",
    "peak shear": r"peak_shear|shear_number",
    "largest tension, its place": r".*tension.*",
    "dissipation": r"dissipation",
    "dissipation of cycles, loss factor, works": r".*cycle_dissipation|dissipation_number|loss_factor|.*_work",
    "stiffnesses, amplitudes": r".*stiffness.*|.*amplitude|force_number|shift_number",
    "turning points of cycles": r"stick_ratio_.*|patch_shift_.*|contact_centre_.*",
    "forces, motions": r".*_force|approach.*|shift.*|rotation.*|moment.*|.*_bulk_stress|.*_contraction.*",
    "creepage": r"creepage.*",
    "wear": r"worn_area|wear_depth",
}


def family(path: str) -> str:
    """The row of a quantity in the table."""
    return next((row for row, names in FAMILIES.items() if re.fullmatch(names, public_name(path))), "others")


def _row(title: str, count: Counter[str]) -> str:
    every = sum(count.values())
    shares = [f"{100 * count[word] / max(every, 1):.1f} %" for word in WORDS[:-1]]
    return f"| {title} | {every} | {' | '.join(shares)} | {count['finding']} |"


def table(records: list[dict[str, Any]]) -> str:
    """Verdicts by family of quantities, bars by kind of mesh, relations, fates, and the scenes of the findings, as Markdown."""
    counts: dict[str, Counter[str]] = {name: Counter() for name in ("all", "ordinary scenes", *FAMILIES, "others")}
    bars: dict[str, Counter[bool]] = defaultdict(Counter)
    related: dict[str, Counter[bool]] = defaultdict(Counter)
    for one in records:
        for path, verdict in one["verdicts"].items():
            for name in ("all", family(path), *(["ordinary scenes"] if one["ordinary"] else [])):
                counts[name][verdict[0]] += 1
        for path, holds in one.get("holds", {}).items():
            if path.startswith("observables/"):
                bars[one["mesh"]][holds] += 1
        for name, paths in one["relations"].items():
            related[name][bool(paths)] += 1
    lines = [f"| quantities | numbers | {' | '.join(WORDS)} |", "| --- " * (len(WORDS) + 2) + "|"]
    lines += [_row(name, count) for name, count in counts.items() if sum(count.values())]
    lines += ["", "| mesh | bars that the truth decides | within twice |", "| --- | --- | --- |"]
    for mesh, held in sorted(bars.items()):
        every = held[True] + held[False]
        lines.append(f"| {mesh} | {every} | {100 * held[True] / every:.1f} % |")
    lines += ["", "| the same problem | scenes | differ |", "| --- | --- | --- |"]
    lines += [f"| {name} | {both[True] + both[False]} | {both[True]} |" for name, both in sorted(related.items())]
    fates = Counter(one["fate"] for one in records)
    lines += ["", "| fate | scenes |", "| --- | --- |", *(f"| {fate} | {number} |" for fate, number in fates.most_common())]
    found: dict[str, set[int]] = defaultdict(set)
    for one in records:
        for name in findings(one):
            found[family(name) if name in one["verdicts"] else name.split(":")[0]].add(one["seed"])
    lines += ["", "| findings | scenes, by seed |", "| --- | --- |"]
    lines += [f"| {name} | {', '.join(map(str, sorted(seeds)))} |" for name, seeds in sorted(found.items())]
    return "\n".join(lines) + "\n"
