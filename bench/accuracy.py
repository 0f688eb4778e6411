"""Speed against accuracy of every solver setting, as Pareto pictures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from events import BODIES, MU, PRESS
from harness import Bench, Case, Tractions, duration, number, stamp
from matplotlib import pyplot

from mfv import reference

QUANTITIES = {"pressure": "pressure, l2", "shear": "shear, l2", "stick": "stick ratio", "dissipation": "dissipation"}
RADIUS, POISSON, SHEAR = 0.25, 0.3, 3.0e-4
KOLOSOV = 3.0 - 4.0 * POISSON
MODULUS = 4.0 / (KOLOSOV + 1.0)
#: &mesh nodes of the meshes, of the mesh for the other settings, and of the finest mesh.
MESHES, MESH, FINEST = (30, 60, 120, 240, 480, 960), 240, 1800
DGESV_MOST = 120
STEPS = [{"normal_force": PRESS}, {"tangential_force": SHEAR}, {"tangential_force": -SHEAR, "cycles": 1}]
CIRCLE, CIRCLE_FORCE_WIDTH = 10000, 50
Errors = dict[str, float]

#: Settings for the coupled scene: name, and the keys of &solver for every value.
KNOBS: dict[str, list[dict[str, Any]]] = {
    "linear_tolerance": [{"linear_solver": "fft", "linear_tolerance": value} for value in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)],
    "accuracy": [{"stepping": "leap", "accuracy": value} for value in (1e-1, 1e-2, 1e-3)],
    "nominal": [{"stepping": "nominal", "load_step": value} for value in (0.2, 0.05, 0.0125)],
    "conventional": [{"algorithm": "conventional", "load_step": value} for value in (0.2, 0.0125, 0.003)],
}


def coupled(nodes: int, coupling: str = "full") -> Case:
    """Pressed and cyclically sheared with friction: path-dependent."""
    return Case(BODIES, STEPS, {"nodes": nodes}, MU, coupling)


def mindlin(nodes: int, stepping: str) -> Case:
    """Decoupled, pressed without friction: Mindlin's closed forms."""
    steps = [STEPS[0] | {"friction": False}, *STEPS[1:]]
    return Case(
        BODIES,
        steps,
        {"nodes": nodes, "gap": "parabolic"},
        MU,
        "none",
        {"stepping": stepping} | ({"accuracy": 1e-3} if stepping == "leap" else {}),
    )


def spence(nodes: int) -> Case:
    """Pressed with friction, Goodman's coupling: Spence's closed forms."""
    return Case(BODIES, STEPS[:1], {"nodes": nodes, "gap": "parabolic"}, SPENCE_MU, "goodman")


SPENCE_MU = 0.2


def disk(harmonics: int) -> Case:
    """An elastic disk on a rigid plane, with this many harmonics per interval; 0: exact kernel."""
    half_width = CIRCLE_FORCE_WIDTH * 2.0 * np.pi / CIRCLE
    force = float(half_width**2 * np.pi * MODULUS / 2.0)
    elastic = {"shape": "disk", "radius": 1.0, "shear_modulus": 1.0, "poisson_ratio": POISSON}
    if harmonics:
        elastic |= {"kernel": "fourier", "harmonics": harmonics * CIRCLE}
    steps = [{"normal_force": force}, {"tangential_force": 0.3 * force}]
    rigid = {"shape": "half_plane", "rigid": True}
    return Case([elastic, rigid], steps, {"nodes": CIRCLE, "half_angle": 180}, MU)


def measure(bench: Bench, quick: bool) -> dict[str, Any]:
    """Everything in this section."""
    meshes = MESHES[:4] if quick else MESHES
    finest = bench.run([coupled(480 if quick else FINEST)])[0]
    base = bench.run([coupled(MESH)], 3)[0]
    data = stamp() | {
        "finest": finest["contact"],
        "base": point("events", base, finest, base),
        "contact": base["contact"],
    }
    data["meshes"] = _meshes(bench, meshes, finest)
    data["knobs"] = _knobs(bench, finest, base)
    data["coupling"] = [
        point(coupling, result, finest, base)
        for coupling in ("goodman", "none")
        for result in bench.run([coupled(MESH).coupled(coupling)], 3)
    ]
    data["closed"] = {
        "Mindlin, events": [_against_mindlin(bench, mindlin(nodes, "event")) for nodes in meshes],
        "Mindlin, large increments": [_against_mindlin(bench, mindlin(nodes, "leap")) for nodes in meshes],
        "Spence, events": [_against_spence(bench, spence(nodes)) for nodes in meshes],
    }
    data["harmonics"] = _harmonics(bench)
    return data


def _meshes(bench: Bench, meshes: tuple[int, ...], finest: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    """Finer meshes with every solver, in turn."""
    found: dict[str, list[dict[str, Any]]] = {"dgesv": [], "reduced": [], "fft": []}
    for nodes in meshes:
        solvers = [solver for solver in found if solver != "dgesv" or nodes <= DGESV_MOST]
        results = bench.run([coupled(nodes).by(linear_solver=solver) for solver in solvers], 3 if nodes <= MESH else 1)
        for solver, result in zip(solvers, results, strict=True):
            found[solver].append(point(nodes, result, finest, result))
    return found


def _knobs(bench: Bench, finest: dict[str, Any], base: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    """Other settings on one mesh; settings that do not complete are omitted."""
    found: dict[str, list[dict[str, Any]]] = {}
    for name, settings in KNOBS.items():
        found[name] = []
        for setting in settings:
            result = bench.run([coupled(MESH).by(**setting)], 3 if name != "conventional" else 1, strict=False)[0]
            label = next(value for key, value in setting.items() if key.endswith(("tolerance", "step", "accuracy")))
            if result["outcome"] == 0:
                found[name].append(point(label, result, finest, base))
            else:
                found[name].append({"label": label, "outcome": result["outcome"]})
    return found


def _harmonics(bench: Bench) -> list[dict[str, Any]]:
    """The Fourier kernel against the exact one, the same mesh."""
    numbers = (0, 1, 4, 16, 64)
    results = bench.run([disk(harmonics) for harmonics in numbers], 3)
    return [point(harmonics, result, results[0], results[0]) for harmonics, result in zip(numbers, results, strict=True)]


def point(label: Any, result: dict[str, Any], finest: dict[str, Any], base: dict[str, Any]) -> dict[str, Any]:
    """Errors relative to the finest run (total), and to `base` on the same mesh (effect of the setting)."""
    return {
        "label": label,
        "outcome": result["outcome"],
        "contact": result["contact"],
        "seconds": result["whole"]["seconds"],
        "solves": result["whole"]["solves"],
        "events": result["whole"]["events"],
        "certificate": result["certificate"],
        "error": errors(result, finest),
        "knob": errors(result, base),
    }


def errors(result: dict[str, Any], other: dict[str, Any]) -> Errors:
    """Relative differences; of the stick ratio absolute. Tractions at the nodes of `result`."""
    here, there = result["tractions"], other["tractions"]
    found = {name: _distance(here, there, name) for name in ("pressure", "shear")}
    ratios = [run["stuck"] / run["contact"] for run in (result, other)]
    found["stick"] = abs(ratios[0] - ratios[1])
    found["dissipation"] = abs(result["dissipation"] / other["dissipation"] - 1.0)
    return found


def _distance(here: Tractions, there: Tractions, name: str) -> float:
    if here.x.size == there.x.size and np.allclose(here.x, there.x, rtol=1e-12, atol=0.0):
        exact = getattr(there, name)
    else:
        exact = np.interp(here.x, there.x, getattr(there, name))
    return float(np.linalg.norm(getattr(here, name) - exact) / np.linalg.norm(exact))


def _closed(result: dict[str, Any], exact: dict[str, Any]) -> dict[str, Any]:
    """Errors against closed forms."""
    tractions = result["tractions"]
    found = {
        name: float(np.linalg.norm(getattr(tractions, name) - exact[name]) / np.linalg.norm(exact[name]))
        for name in ("pressure", "shear")
    }
    found["stick"] = abs(result["stuck"] / result["contact"] - float(exact["stick"]))
    if "dissipation" in exact:
        found["dissipation"] = abs(result["dissipation"] / float(exact["dissipation"]) - 1.0)
    return {
        "contact": result["contact"],
        "seconds": result["whole"]["seconds"],
        "error": found,
        "label": result["nodes"],
    }


def _against_mindlin(bench: Bench, case: Case) -> dict[str, Any]:
    result = bench.run([case], 3)[0]
    width = float(reference.hertz_half_width(PRESS, RADIUS, 1.0, KOLOSOV))
    x = result["tractions"].x
    cycle = reference.mindlin_dissipation(SHEAR, PRESS, width, RADIUS, MU)
    exact = {
        "pressure": reference.hertz_pressure(x, PRESS, width),
        "shear": reference.mindlin_shear(x, SHEAR, PRESS, width, MU),
        # After -Q and back to Q the stick zone is that of first loading (Masing).
        "stick": reference.mindlin_stick_ratio(SHEAR, PRESS, MU),
        "dissipation": 1.25 * cycle,
    }
    return _closed(result, exact)


def _against_spence(bench: Bench, case: Case) -> dict[str, Any]:
    result = bench.run([case], 3)[0]
    width = float(reference.hertz_half_width(PRESS, RADIUS, 1.0, KOLOSOV))
    x, beta = result["tractions"].x, (KOLOSOV - 1.0) / (KOLOSOV + 1.0)
    exact = {
        "pressure": reference.hertz_pressure(x, PRESS, width),
        "shear": np.nan_to_num(reference.spence_cylinder_shear(x, PRESS, width, SPENCE_MU, beta)),
        "stick": reference.spence_stick_ratio(SPENCE_MU, beta),
    }
    if np.dot(exact["shear"], result["tractions"].shear) < 0.0:
        exact["shear"] = -exact["shear"]
    return _closed(result, exact)


def section(data: dict[str, Any], pictures: Path) -> str:
    """The text."""
    draw_closed(data, pictures / "pareto_closed_forms.png")
    draw_knobs(data, pictures / "pareto_knobs.png")
    coarse, fine = data["meshes"]["reduced"][0], data["meshes"]["reduced"][-1]
    dgesv = data["meshes"]["dgesv"][-1]
    same = next(entry for entry in data["meshes"]["reduced"] if entry["label"] == dgesv["label"])
    mindlin_events, mindlin_leaps = data["closed"]["Mindlin, events"][-1], data["closed"]["Mindlin, large increments"][-1]
    knobs, base = data["knobs"], data["base"]
    loose, tight = knobs["linear_tolerance"][0], knobs["linear_tolerance"][-1]
    enough = max(
        (entry for entry in knobs["linear_tolerance"] if entry["outcome"] == 0 and _worst(entry["knob"]) <= 1e-3),
        key=lambda entry: entry["label"],
        default=tight,
    )
    nominal = knobs["nominal"][1]
    conventional = [entry for entry in knobs["conventional"] if entry["outcome"] == 0]
    goodman, none = data["coupling"]
    few, many = data["harmonics"][2], data["harmonics"][-1]
    loose_text = (
        f"down to {_time(loose)} with {loose['label']:g}" if loose["outcome"] == 0 else f"(with {loose['label']:g} it ends early)"
    )
    return f"""## Speed against accuracy: which knob first?

Two pictures: errors against closed forms (Mindlin: pressed without friction, sheared to Q, -Q, Q, decoupled; Spence: pressed with friction, mu = {SPENCE_MU},
Goodman), and every knob on a scene where the path matters ({data["contact"]} nodes in contact, pressed with friction, sheared to Q, -Q, Q, full coupling, nu = {POISSON},
mu = {MU}, Q = {SHEAR / (MU * PRESS):g} mu P) against {data["finest"]} nodes in contact. Tractions by the l2 norm over the nodes, the stick ratio in parts of the contact, which comes
in whole nodes.

![Errors over time for closed forms](pictures/pareto_closed_forms.png)

![Errors over time for every knob](pictures/pareto_knobs.png)

*Nodes: first.* From {coarse["contact"]} to {fine["contact"]} in contact the error of the shear falls from {_error(coarse, "shear")} to {_error(fine, "shear")}, that of the dissipation from
{_error(coarse, "dissipation")} to {_error(fine, "dissipation")}, in {_time(coarse)} and {_time(fine)}. No other knob brings the error below that of its mesh.

*linear_solver: leave it `auto`.* It costs no accuracy: at {same["contact"]} nodes in contact dgesv takes {_time(dgesv)}, reduced {_time(same)}, fft
{_time(_at(data["meshes"]["fft"], same["label"]))} for the same events; at {fine["contact"]} reduced {_time(fine)}, fft {_time(_at(data["meshes"]["fft"], fine["label"]))}.

*accuracy: on fine meshes, and under constant pressures.* For Mindlin with {mindlin_leaps["contact"]} nodes in contact large increments take {duration(mindlin_leaps["seconds"])} where events take {duration(mindlin_events["seconds"])}, with
errors of the shear of {mindlin_leaps["error"]["shear"]:.1e} and {mindlin_events["error"]["shear"]:.1e}, of the dissipation of {mindlin_leaps["error"]["dissipation"]:.1e} and {mindlin_events["error"]["dissipation"]:.1e}. With coupling they pay from about 400 nodes
on ([below](#against-contact)); on the coupled scene of the second picture, with `stepping='leap'`, they cost more than events, which `stepping='auto'` takes there.

*coupling: physics, not speed.* `goodman` takes {_time(goodman)} in place of {_time(base)} and is wrong by {_knob(goodman, "pressure")} in pressure, {_knob(goodman, "shear")} in shear and {_knob(goodman, "dissipation")} in dissipation; `none`
{_time(none)}, {_knob(none, "pressure")}, {_knob(none, "shear")} and {_knob(none, "dissipation")}. Those errors are larger than those of all but the coarsest meshes.

*linear_tolerance: with fft only.* From {tight["label"]:g} ({_time(tight)}) {loose_text}; {enough["label"]:g} changes nothing by more than {_worst(enough["knob"]):.0e} and takes {_time(enough)}.

*stepping='nominal': no trade.* With load_step {nominal["label"]:g} the same states ({_knob(nominal, "shear")} in shear) in {_time(nominal)}: for comparison with the dissertation.

*algorithm='conventional': for comparison.* {conventional_text(conventional, knobs["conventional"])} An MFV run takes {_time(base)} and has no load step to choose.

*kernel='fourier', harmonics: none.* On a disk of {CIRCLE} intervals the exact kernel takes {_time(data["harmonics"][0])} for the run; {few["label"]} harmonics an interval {_time(few)} with {_knob(few, "shear")} wrong in shear, {many["label"]} {_time(many)} with
{_knob(many, "shear")}.
"""


def _time(entry: dict[str, Any]) -> str:
    return duration(entry["seconds"])


def _error(entry: dict[str, Any], quantity: str) -> str:
    return percent(entry["error"][quantity])


def _knob(entry: dict[str, Any], quantity: str) -> str:
    return percent(entry["knob"][quantity])


def percent(value: float) -> str:
    """Per cent, or a ratio if it is tiny."""
    return f"{number(100.0 * value)} %" if value >= 1e-5 else f"{value:.0e}"


def _worst(found: Errors) -> float:
    return max(found.values())


def _at(entries: list[dict[str, Any]], label: Any) -> dict[str, Any]:
    return next(entry for entry in entries if entry["label"] == label)


def conventional_text(done: list[dict[str, Any]], tried: list[dict[str, Any]]) -> str:
    """Results of the conventional algorithm."""
    early = [f"{entry['label']:g}" for entry in tried if entry["outcome"] != 0]
    text = f"With load_step {', '.join(early)} it ends early. " if early else ""
    if not done:
        return text
    words = [
        f"with {entry['label']:g} it takes {_time(entry)} and differs by {_knob(entry, 'shear')} in shear and "
        f"{_knob(entry, 'dissipation')} in dissipation"
        for entry in done
    ]
    return text + f"{'; '.join(words).capitalize()}."


def draw_closed(data: dict[str, Any], path: Path) -> None:
    """Errors over time, closed forms."""
    _draw(path, lambda: [(name, entries, "o-") for name, entries in data["closed"].items()])


def draw_knobs(data: dict[str, Any], path: Path) -> None:
    """Errors over time, every knob."""

    def lines() -> list[tuple[str, list[dict[str, Any]], str]]:
        found = [(f"nodes, {solver}", entries, "o-") for solver, entries in data["meshes"].items()]
        for (name, entries), mark in zip(data["knobs"].items(), ("v:", "^:", "D:", "x:"), strict=True):
            found.append((name, [entry for entry in entries if entry["outcome"] == 0], mark))
        return [*found, ("coupling goodman, none", data["coupling"], "P")]

    _draw(path, lines)


def _draw(path: Path, lines: Callable[[], list[tuple[str, list[dict[str, Any]], str]]]) -> None:
    """Four panels, one per quantity."""
    figure, panels = pyplot.subplots(2, 2, figsize=(9.5, 7.5), layout="constrained", sharex=True)
    for axes, (quantity, title) in zip(panels.flat, QUANTITIES.items(), strict=True):
        for name, entries, mark in lines():
            shown = [entry for entry in entries if entry["error"].get(quantity, 0.0) > 1e-7]
            axes.loglog(
                [entry["seconds"] for entry in shown],
                [entry["error"][quantity] for entry in shown],
                mark,
                label=name,
                markersize=5,
                linewidth=1.2,
            )
        axes.set_title(title)
        axes.set_ylabel("error")
        axes.grid(alpha=0.3)
    for axes in panels[1]:
        axes.set_xlabel("seconds")
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3, frameon=False)
    figure.savefig(path, dpi=130)
    pyplot.close(figure)
