"""Results in Python: xarray, notebooks, pickles; every panel of mfv.plot."""

from __future__ import annotations

import copy
import inspect
import os
import pickle
import subprocess
import sys
import xml.etree.ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scenes import PRESS, cylinder

import mfv
from mfv.commands.info import description
from mfv.compare import compare

TO_AND_FRO = (
    mfv.Step(normal_force=5.0e-4),
    mfv.Step(tangential_force=2.0e-4),
    mfv.Step(tangential_force=-2.0e-4, cycles=2),
)


@pytest.fixture(scope="module")
def cycled() -> mfv.Result:
    """The cylinder sheared to and fro, with full coupling."""
    return cylinder(*TO_AND_FRO, coupling="full", title="to & fro", length_unit="mm", force_unit="N").run(check=True)


@pytest.fixture(scope="module")
def pressed() -> mfv.Result:
    """The cylinder, pressed without friction and turned."""
    return cylinder(PRESS, mfv.Step(rotation=1.0e-6)).run(check=True)


@pytest.fixture(scope="module")
def watched() -> mfv.Result:
    """The cylinder sheared to and fro, with the stress beside it in every row of the history."""
    units = {"length_unit": "mm", "force_unit": "N"}
    return cylinder(*TO_AND_FRO, coupling="full", output=mfv.Output(stress_at=0.02), **units).run(check=True)


def test_moduli_in_another_unit_are_warned_of() -> None:
    """Pa beside mm and N; not without names of units, and not for real materials."""
    steel = {"youngs_modulus": 210e3, "poisson_ratio": 0.3}
    pascals = steel | {"youngs_modulus": 210e9}
    units = {"length_unit": "mm", "force_unit": "N"}

    def warnings(lower: mfv.Body, **units: str) -> list[str]:
        result = mfv.Scene(lower, mfv.Body.disk(10.0, **steel), steps=[mfv.Step(normal_force=100.0)], **units).run()
        return [warning for warning in result.warnings if "diamond" in warning]

    coated = mfv.Body.half_plane(**steel, layers=[mfv.Layer(thickness=1.0, **pascals)])
    assert (
        "the lower body, or a layer of it, has a contact modulus E* of 2.3e11 N/mm^2"
        in warnings(mfv.Body.half_plane(**pascals), **units)[0]
    )
    assert len(warnings(coated, **units)) == 1
    assert not warnings(mfv.Body.half_plane(**pascals)) and not warnings(mfv.Body.half_plane(**steel), **units)
    assert not warnings(mfv.Body.half_plane(**pascals), length_unit="m", force_unit="N")


def test_panels_of_cycles_need_cycles(pressed: mfv.Result) -> None:
    for panel in (mfv.plot.nonlinear_loop, mfv.plot.friction_work, mfv.plot.cycles_figure):
        with pytest.raises(ValueError, match="this result has no cycles; give a step cycles="):
            panel(pressed)


# --- xarray ---


def test_datasets_have_every_quantity_with_its_coordinates(cycled: mfv.Result) -> None:
    datasets = cycled.to_xarray()
    assert {"mesh", "state", "summary", "history", "cycles", "certificate", "steps"} <= set(datasets)
    state = datasets["state"]
    assert state.pressure.dims == ("x",) and state.pressure.attrs["units"] == "N/mm^2"
    assert "compressive" in state.pressure.attrs["long_name"] and state.x.attrs["units"] == "mm"
    np.testing.assert_array_equal(state.x, cycled.mesh.x)
    assert state.attrs["title"] == "to & fro" and "input" not in state.attrs
    assert datasets["history"]["shift"].dims == ("record",) and datasets["summary"]["shift"].dims == ()
    assert datasets["cycles"].dissipation.dims == ("cycle",) and datasets["cycles"].friction_work.dims == ("x",)
    for name, dataset in datasets.items():
        group = cycled.steps[0] if name == "steps" else getattr(cycled, name)
        assert set(dataset.variables) >= set(group), name


def test_steps_are_stacked_along_state(cycled: mfv.Result) -> None:
    steps = cycled.to_xarray()["steps"]
    assert steps.pressure.dims == ("state", "x") and steps["shift"].dims == ("state",)
    assert steps.pressure.attrs["units"] == "N/mm^2" and steps.x.dims == ("x",)
    assert list(steps.state) == list(range(1, len(cycled.steps) + 1))
    for number, step in enumerate(cycled.steps, start=1):
        chosen = steps.sel(state=number)
        np.testing.assert_array_equal(chosen.shear, step.shear)
        assert float(chosen["shift"]) == step.shift and int(chosen.reversal) == step.reversal


def test_a_file_gives_the_same_datasets(tmp_path: Path) -> None:
    scene = cylinder(*TO_AND_FRO, output=mfv.Output(error_estimate=True))
    ran, read = scene.run(output=tmp_path / "x.h5"), mfv.read(tmp_path / "x.h5")
    here, there = ran.to_xarray(), read.to_xarray()
    assert here.keys() == there.keys()
    for name in here:
        there[name].attrs.pop("hdf5_version")  # which a file alone has
        xarray.testing.assert_identical(here[name], there[name])
    assert here["error_estimate"].stick_ratio_companions.dims == ("companion_nodes",)


def test_a_result_says_how_certain_its_observables_are(cycled: mfv.Result) -> None:
    with pytest.raises(ValueError, match="no error bars: run with error_estimate=True"):
        cycled.error_bar("stick_ratio")
    few = cylinder(*TO_AND_FRO, mesh=mfv.Mesh(nodes=15), output=mfv.Output(error_estimate=True)).run()
    assert few.unresolved and few.warnings == few.attributes["warnings"].split("\n")
    # None that are not there, and no prescribed loads.
    assert set(few.unresolved) <= set(few.observables) - {"normal_force", "tangential_force"}
    bars = {name: few.error_bar(name) for name in few.observables if f"{name}_error" in few.error_estimate}
    assert {name for name, bar in bars.items() if np.isnan(bar)} <= set(few.unresolved)
    assert 0.0 < bars["contact_length"] < 0.3 * few.observables.contact_length
    with pytest.raises(KeyError, match="no observable 'stick_ratoi'; did you mean stick_ratio"):
        few.error_bar("stick_ratoi")
    for name, words in (
        ("stick_left", "no error bar of its own: take that of left_slip_zone"),
        ("contact_right", "no error bar of its own: take that of contact_length"),
        ("contact_nodes", "no error bar of its own: counts"),
    ):
        with pytest.raises(KeyError, match=words):
            few.error_bar(name)


def test_numbers_that_are_not_resolved_are_marked(cycled: mfv.Result) -> None:
    """In one way, in what is printed and drawn; those that are resolved are not."""
    few = cylinder(*TO_AND_FRO, mesh=mfv.Mesh(nodes=15)).run()
    mark = "(not resolved)"
    told = {line.split()[0]: line for line in description(few).splitlines() if line.startswith("  ")}
    assert mark in told["cycle_dissipation"] and mark not in told["normal_force"]
    assert {name for name, line in told.items() if mark in line} <= set(few.unresolved)
    both = {line.split()[0]: line for line in compare(cycled, few).describe().splitlines() if line.startswith("  ")}
    assert both["stick_ratio"].endswith(mark) and mark not in both["normal_force"]
    (caption,) = (legend.get_title().get_text() for legend in mfv.plot.cycles_figure(few).legends)
    assert f"dissipates {few.observables.cycle_dissipation:.4g} {mark}" in caption.replace("\n", " ")
    for resolved in (description(cycled), *(legend.get_title().get_text() for legend in mfv.plot.cycles_figure(cycled).legends)):
        assert (mark in resolved) == bool(cycled.unresolved)


def test_stresses_of_a_file_run_along_depth_and_x(cycled: mfv.Result) -> None:
    grid = {"depth": ("depth",), "x": ("x",), "von_mises": ("depth", "x")}
    shapes = {"depth": np.arange(2.0), "x": np.arange(3.0), "von_mises": np.ones((2, 3))}
    fields = {name: mfv.result.Field(shapes[name], "1", name, dimensions) for name, dimensions in grid.items()}
    dataset = mfv.Group(fields).to_xarray()
    assert dataset.von_mises.dims == ("depth", "x") and set(dataset.coords) == {"depth", "x"}


def test_a_result_that_grew_its_mesh_can_be_stacked() -> None:
    with cylinder(mesh=mfv.Mesh(nodes=31)).contact() as case:
        for force in (1.0e-4, 1.0e-3):
            case.advance(normal_force=force, friction=False)
        result = case.result()
    assert result.mesh.x.size > 31
    assert result.to_xarray()["steps"].pressure.shape == (2, result.mesh.x.size)


# --- copies and notebooks ---


def test_modules_are_there_by_name_and_loaded_on_first_use() -> None:
    names = {"animate", "compare", "comparison_figure", "load_history", "plot", "report", "template"}
    script = f"""
import sys, mfv
loaded = {{"numpy", "matplotlib", "h5py", "f90nml", "mfv.scene", "importlib.metadata"}} & set(sys.modules)
assert not loaded and {names!r} <= set(dir(mfv)), loaded
mfv.Scene, mfv.Case
loaded = {{"matplotlib", "h5py", "f90nml", "mfv.studies", "mfv.profiles"}} & set(sys.modules)
assert not loaded, loaded
assert set(mfv.__all__) <= set(dir(mfv)) and all(hasattr(mfv, name) for name in mfv.__all__)
assert all(getattr(mfv, name).__name__ == f"mfv.{{name}}" for name in {sorted(names)!r})
"""
    environment = {**os.environ, "PYTHONPATH": str(Path(mfv.__file__).parents[1])}
    subprocess.run([sys.executable, "-c", script], env=environment, check=True, timeout=60)
    assert {"GrossSliding", "InputError", "NotAResult"} <= set(dir(mfv.errors))


def test_results_can_be_pickled_and_copied(cycled: mfv.Result) -> None:
    for other in (pickle.loads(pickle.dumps(cycled)), copy.deepcopy(cycled)):
        assert repr(other) == repr(cycled)
        np.testing.assert_array_equal(other.steps[1].shear, cycled.steps[1].shear)
        assert other.state.shear is not cycled.state.shear
        xarray.testing.assert_identical(other.to_xarray()["steps"], cycled.to_xarray()["steps"])


def test_groups_are_compared_by_their_values_which_cannot_be_set(cycled: mfv.Result) -> None:
    other = pickle.loads(pickle.dumps(cycled))
    assert other.state == cycled.state and other.history == cycled.history
    nothing = [mfv.Group({"x": mfv.result.Field(np.array([np.nan, 1.0]), "1", "x")}) for _ in range(2)]
    assert nothing[0] == nothing[1]
    assert cycled.state != cycled.steps[0] and cycled.state != cycled.summary and cycled.state != 1
    other.state.shear[30] += 1.0e-9
    assert other.state != cycled.state
    with pytest.raises(AttributeError, match="'pressure' is a quantity of the result and cannot be set"):
        other.state.pressure = 1.0
    np.testing.assert_array_equal(other.state.pressure, cycled.state.pressure)


def test_groups_know_what_their_quantities_run_along(cycled: mfv.Result) -> None:
    np.testing.assert_array_equal(cycled.state.x, cycled.mesh.x)
    np.testing.assert_array_equal(cycled.steps[0]["x"], cycled.mesh.x)
    assert "x" in cycled.state and "x" in dir(cycled.state) and "x" not in list(cycled.state)
    assert cycled.state.unit("x") == "mm"
    assert "x" not in cycled.summary and "record" not in cycled.state
    with pytest.raises(AttributeError, match="cannot be set"):
        cycled.state.x = 1.0


def test_notebooks_show_results_without_scripts(cycled: mfv.Result) -> None:
    shown = cycled._repr_html_()
    for word in ("to &amp; fro", "complete: step 3 was reached", "certificate"):
        assert word in shown
    group = cycled.state._repr_html_()
    for word in ("pressure", "(61)", "N/mm^2", "compressive"):
        assert word in group
    for page in (shown, group, cycled.summary._repr_html_()):
        assert "<script" not in page and "to & fro" not in page
        xml.etree.ElementTree.fromstring(page)  # well-formed


# --- panels ---


PANELS: dict[str, tuple[str, str, str]] = {
    "pressure": ("cycled", "position $x$ [mm]", "pressure $p$ [N/mm$^2$]"),
    "shear": ("cycled", "position $x$ [mm]", r"shear traction $\tau$ [N/mm$^2$]"),
    "surfaces": ("pressed", "position $x$", "height $y$"),
    "loop": ("cycled", "shift $U$ [mm]", "tangential force $Q$ [N/mm]"),
    "nonlinear_loop": ("cycled", "non-linear shift $U - Q/k$ [mm]", "tangential force $Q$ [N/mm]"),
    "friction_work": ("cycled", "position $x$ [mm]", "dissipation per cycle and area $d$ [N/mm]"),
    "turning": ("pressed", r"rotation $\varphi$ [rad]", "moment $M$"),
    "surface_stress": ("cycled", "position $x$ [mm]", r"stress along the surface $\sigma_{xx}$ [N/mm$^2$]"),
    "tension": ("watched", "turning point of the last cycle", r"stress along the surface $\sigma$ [N/mm$^2$]"),
    "rolling": ("pressed", "rolled distance $s$", r"sliding $U + h\varphi$"),
}


def drawn(ax: Axes) -> np.ndarray:
    """Heights of all points that lines have."""
    return np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in ax.lines])


@pytest.mark.parametrize("name", PANELS)
def test_a_panel_takes_an_axes_or_makes_one_and_returns_it(name: str, request: pytest.FixtureRequest) -> None:
    which, xlabel, ylabel = PANELS[name]
    result = request.getfixturevalue(which)
    panel: Callable[..., Axes] = getattr(mfv.plot, name)
    ax = Figure().subplots()
    assert panel(result, ax) is ax
    made = panel(result)
    try:
        assert made is not ax and made.figure.number in pyplot.get_fignums()
        for axes in (ax, made):
            assert (axes.get_xlabel(), axes.get_ylabel()) == (xlabel, ylabel)
        np.testing.assert_array_equal(drawn(ax), drawn(made))
        assert np.ptp(drawn(ax)[np.isfinite(drawn(ax))]) > 0.0
    finally:
        pyplot.close(made.figure)
    parameters = inspect.signature(panel).parameters
    assert list(parameters) == ["result", "ax", "step"] and parameters["ax"].default is None


def test_panels_draw_the_state_that_is_asked_for(cycled: mfv.Result) -> None:
    ax = mfv.plot.shear(cycled, Figure().subplots(), 2)
    (points,) = (line for line in ax.lines if line.get_label() == "computed")
    np.testing.assert_array_equal(points.get_ydata(), cycled.steps[1].shear)
    ax = mfv.plot.friction_work(cycled, Figure().subplots())
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), cycled.cycles.friction_work)


def test_a_legend_names_everything_once(cycled: mfv.Result) -> None:
    labels = mfv.plot.shear(cycled, Figure().subplots()).get_legend_handles_labels()[1]
    assert len(labels) == len(set(labels)) >= 4 and "computed" in labels


def test_cycles_of_a_moment_are_drawn_over_the_rotation() -> None:
    rocked = PRESS, mfv.Step(moment=1.0e-7, cycles=2)
    axes = mfv.plot.cycles_figure(cylinder(*rocked, coupling="full").run(check=True)).axes
    assert [ax.get_xlabel() for ax in axes] == [r"rotation $\varphi$ [rad]", "position $x$"]
    narrow = mfv.plot.cycles_figure(cylinder(*rocked, output=mfv.Output(history="none")).run(check=True))
    assert [ax.get_xlabel() for ax in narrow.axes] == ["position $x$"]
    narrow.draw_without_rendering()
    assert all(text.get_window_extent().width < narrow.bbox.width for text in narrow.texts)


def test_contours_of_stresses_take_an_axes_or_make_one(cycled: mfv.Result) -> None:
    field = mfv.stress.grid(cycled, across=41, down=21)
    ax = Figure().subplots()
    assert mfv.plot.stress_contours(field, ax, "sigma_xx") is ax
    assert len(ax.figure.axes) == 1 and ax.collections
    made = mfv.plot.stress_contours(field, colour_bar=True)
    try:
        assert made.child_axes[0].get_ylabel() == r"$\sigma_\mathrm{vM}$$/p_0$"
    finally:
        pyplot.close(made.figure)


def numbers_on(ax: Axes) -> list[int]:
    """The numbers of states that a curve names."""
    return sorted(int(number) for text in ax.texts for number in text.get_text().split(",") if number.strip().isdigit())


def test_curves_name_saved_states_of_the_last_cycle(cycled: mfv.Result) -> None:
    """Steps 1 and 2, and the two reversals of the second of two cycles; of many turning points the reversals and the end."""
    assert [int(state.reversal) for state in cycled.steps] == [1, 1, 1, 2, 3, 4]
    assert numbers_on(mfv.plot.loop(cycled, Figure().subplots())) == [1, 2, 5, 6]
    phase = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    turning_points = mfv.History(tangential_force=2.0e-4 * np.sin(phase), period=24, cycles=3)
    kept = mfv.Output(states="last_cycle")
    result = cylinder(mfv.Step(normal_force=5.0e-4), coupling="full", output=kept, history=turning_points).run(check=True)
    named = numbers_on(mfv.plot.loop(result, Figure().subplots()))
    assert len(result.steps) == 25 and named[0] == 1 and named[-1] == 25 and len(named) == 4
    forces = [result.steps[number - 1].tangential_force for number in named]
    assert max(forces) == pytest.approx(2.0e-4) and min(forces) == pytest.approx(-2.0e-4)
    assert 9 in numbers_on(mfv.plot.loop(result, Figure().subplots(), 9))


def test_a_bulk_stress_adds_the_stress_along_the_surface(cycled: mfv.Result) -> None:
    """Its peak is the tension of the summary; without a bulk stress there is no such panel in the picture."""
    pulled = mfv.Step(tangential_force=2.0e-4, lower_bulk_stress=1.0e-3)
    result = cylinder(PRESS, pulled, output=mfv.Output(stress_at=0.02)).run(check=True)
    labels = [ax.get_ylabel() for ax in mfv.plot.figure(result).axes]
    assert r"stress along the surface $\sigma_{xx}$" in labels and len(labels) == 5
    assert all("sigma_{xx}" not in ax.get_ylabel() for ax in mfv.plot.figure(cycled).axes)
    drawn_stress = drawn(mfv.plot.surface_stress(result, Figure().subplots()))
    assert np.nanmax(drawn_stress) == pytest.approx(result.observables.lower_tension, rel=0.02)


def test_spikes_at_corners_do_not_flatten_the_rest() -> None:
    punch = mfv.Scene(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
        mfv.Body.flat_punch(0.4),
        mesh=mfv.Mesh(nodes=401),
        steps=[mfv.Step(normal_force=1.0e-3)],
    ).run(check=True)
    ax = mfv.plot.pressure(punch, Figure().subplots())
    assert ax.get_ylim()[1] == pytest.approx(mfv.plot.SPIKE * np.median(punch.state.pressure))
    assert f"up to {punch.state.pressure.max():.3g}" in ax.texts[0].get_text()
    surfaces = mfv.plot.surfaces(punch, Figure().subplots())
    assert np.ptp(surfaces.get_ylim()) > 1.0e-4 * abs(punch.summary.approach)


def test_limits_of_friction_are_drawn_whole_where_there_is_no_shear() -> None:
    pressed = cylinder(PRESS, coupling="none").run(check=True)
    assert np.all(pressed.state.shear == 0.0)
    ax = mfv.plot.shear(pressed, Figure().subplots())
    limit = float(np.max(pressed.mesh.static_friction * pressed.state.pressure))
    assert -ax.get_ylim()[0] >= limit and ax.get_ylim()[1] >= limit and not ax.texts


def test_panels_are_all_tested_here() -> None:
    taking_axes = {
        name
        for name, function in inspect.getmembers(mfv.plot, inspect.isfunction)
        if not name.startswith("_") and function.__module__ == "mfv.plot" and "ax" in inspect.signature(function).parameters
    }
    assert taking_axes == {*PANELS, "stress_contours", "parameter_contours"}


def test_dimensions_of_many_states_are_read_without_a_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """HDF5 searches the file for the name of a scale, so that reading took the square of the number of states."""
    import h5py

    path = tmp_path / "pressed.h5"
    cylinder(*(mfv.Step(normal_force=1.0e-3 * part) for part in (0.2, 0.4, 0.6, 0.8, 1.0))).run(check=True, output=path)
    monkeypatch.setattr(h5py.Dataset, "name", property(lambda self: pytest.fail("a name was searched")))
    read = mfv.read(path)
    assert len(read.steps) == 5 and read.steps[2].to_xarray()["pressure"].dims == ("x",)
    assert read.history.to_xarray()["shift"].dims == ("record",)
