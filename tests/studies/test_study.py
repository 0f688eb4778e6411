"""mfv.study: axes, results and references, in one process."""

import math

import h5py
import numpy as np
import pandas
import pytest
import scipy.stats
import xarray
from small import AXES, BASE, CASES, PAD, PAD_FORCES, write

import mfv
from mfv.studies import dataset
from mfv.studies.cases import OF_MESHES, Solved, observables
from mfv.studies.figure import lines

MOMENTS, TRACTIONS = ("loading", "reversal", "return"), ("pressure", "shear")


def flat(table, name):
    """The values of a column, by the number of the case."""
    return table[name].values.ravel()


def test_rows_are_what_a_run_gives(study):
    folder, table = study
    planned = mfv.Study(folder / "base.nml", AXES)
    assert list(flat(table, "case")) == list(range(1, CASES + 1))
    for number in (1, 8, 11, 18):
        result = mfv.run(text=planned.text(number))
        assert flat(table, "outcome")[number - 1] == result.attributes["outcome"]
        for name in ("events", "linear_solves", "largest_residual", "steps_done"):
            assert flat(table, name)[number - 1] == result.summary[name], name
        assert flat(table, "nodes")[number - 1] == result.mesh.x.size
        for name in observables():
            value = flat(table, name)[number - 1]
            assert value == result.observables[name] if name in result.observables else math.isnan(value), name
            if name in result.observables:
                assert table[name].attrs["units"] == result.observables.unit(name)
                assert table[name].attrs["long_name"] == result.observables.description(name)


def test_axes_are_coordinates(study):
    folder, table = study
    assert dict(table.sizes) == {"friction%mu": 2, "Q": 3, "scene%coupling": 3}
    np.testing.assert_array_equal(table["friction%mu"], [0.3, 0.7])
    assert list(table["scene%coupling"].values) == ["full", "goodman", "none"]
    assert table["Q"].attrs["units"] == "N/mm" and table["cycle_dissipation"].attrs["units"] == "N"
    assert table["friction%mu"].attrs["units"] == "1" and "&friction mu" in table["friction%mu"].attrs["long_name"]
    assert float(table["base"] == str(folder / "base.nml"))
    work = table["cycle_dissipation"].sel({"friction%mu": 0.7, "scene%coupling": "full"})
    assert work.dims == ("Q",) and np.isfinite(work).all()


def test_the_dataset_explains_itself(study):
    _, table = study
    assert table.attrs["base_1"] == BASE.format(nodes=21, cycles=1)
    assert table.attrs["complete"] == 1 and table.attrs["cases"] == table.attrs["cases_done"] == CASES
    assert table.attrs["cases_complete"] + table.attrs["cases_gross_sliding"] == CASES
    assert table.attrs["mfv_version"] == mfv.library_version()
    assert all(table[name].attrs["units"] and table[name].attrs["long_name"] for name in table.data_vars)


def test_early_ends_are_there(study):
    _, table = study
    early = flat(table, "status") != 0
    assert early.sum() == 3 and set(flat(table, "outcome")[early]) == {"gross sliding"}
    assert all(flat(table, "steps_done")[early] == 1) and all(np.isnan(flat(table, "cycle_dissipation")[early]))
    assert "base.nml: &step 2 tangential_force=4e-4 not reached" in flat(table, "message")[early][0]
    np.testing.assert_allclose(flat(table, "tangential_force")[early], 3e-4, rtol=1e-9)


def marked(table, number):
    """Observables of a case that `unresolved` names, and those whose bar is NaN; both of the ones with bars in any case or named."""
    named = set(flat(table, "unresolved")[number].split())
    bars = {name: flat(table, f"{name}_error") for name in observables() if f"{name}_error" in table}
    with_bars = [name for name, bar in bars.items() if name in named or np.isfinite(bar).any()]
    there = {name for name in with_bars if np.isfinite(flat(table, name)[number])}
    return there & named, {name for name in there if np.isnan(bars[name][number])}


@pytest.mark.parametrize(
    "change",
    [
        ("", ""),
        ("mu=0.65 /", "mu=0.65 /\n&mesh nodes=11, half_width=2.0 /"),
        ("normal_force=500", "approach=0.04"),
        ("step tangential_force", "step shift"),
        (", cycles=1", ""),
        ("&body shape='disk', radius=127", "&body shape='rounded_punch', edge_radius=2, half_width=2.0"),
    ],
)
def test_what_is_not_resolved_is_what_has_no_bar(change, tmp_path):
    """The names of the warnings stand for the same observables as in the library, which has no bars of these."""
    (tmp_path / "pad.nml").write_text(PAD.replace(*change))
    keys = ["step(2)%shift", "step(3)%shift"] if "shift" in change[1] else PAD_FORCES.keys
    values = [5e-4, 4e-3] if "shift" in change[1] else [6.5, 50.0]
    table = mfv.study(tmp_path / "pad.nml", {"Q": mfv.Axis(keys, values, [1, -1])}, error_estimate=True)
    assert set(flat(table, "error_estimate")) <= {"yes"} or "nodes" in change[1], flat(table, "error_estimate")
    pairs = [marked(table, number) for number in range(2) if flat(table, "error_estimate")[number] == "yes"]
    for named, without in pairs:
        assert named == without
    assert pairs == [] or pairs[0][0]


def test_values_in_doubt(tmp_path):
    """`flagged` and hollow markers: what is not resolved, and all of a case with another warning."""
    (tmp_path / "pad.nml").write_text(PAD)
    table = mfv.study(tmp_path / "pad.nml", {"Q": PAD_FORCES, "friction%mu": [0.5, 0.65]}, error_estimate=True)
    assert table.attrs["cases_flagged"] == 2
    assert mfv.studies.flagged(table, "cycle_dissipation").values.tolist() == [[True, True], [False, False], [False, False]]
    assert not mfv.studies.flagged(table, "approach").any()
    axes = lines(table)
    assert axes.get_xlabel() == "Q [N/mm]" and axes.get_ylabel() == "cycle_dissipation [N]"
    hollow = [line for line in axes.lines if str(line.get_markerfacecolor()) == "white"]
    assert sum(len(line.get_xdata()) for line in hollow) == 2 and len(axes.collections) == 2
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words == ["friction%mu = 0.5", "friction%mu = 0.65", "in doubt: see its warnings"]
    (tmp_path / "steep.nml").write_text(PAD.replace("radius=127", "radius=0.2"))
    table = mfv.study(tmp_path / "steep.nml", {"Q": PAD_FORCES}, observables="approach")
    assert "degrees" in flat(table, "warnings")[2] and mfv.studies.flagged(table, "approach").all()
    with pytest.raises(ValueError, match="13 lines; at most 12"):
        many = mfv.study(tmp_path / "pad.nml", {"Q": PAD_FORCES, "friction%mu": list(np.linspace(0.5, 0.8, 13))})
        lines(many, over="Q")


def test_means_over_realisations(study, tmp_path):
    """Against scipy, over any axis; what is undefined or in doubt in a realisation is in doubt in the mean; pictures and files."""
    from mfv.studies import flagged, mean_over

    _, table = study
    complete = table.sel({"Q": 2e-4}, method="nearest")
    mean = mean_over(complete, "friction%mu")
    assert mean["case"].dims == ("scene%coupling",) and mean["realisations"].values.tolist() == [2, 2, 2]
    values = complete["dissipation"].transpose("friction%mu", ...).values
    np.testing.assert_allclose(mean["dissipation"], values.mean(axis=0), rtol=1e-14)
    interval = scipy.stats.t.interval(0.95, 1, values.mean(axis=0), scipy.stats.sem(values, axis=0))
    np.testing.assert_allclose(mean["dissipation_error"], 0.5 * (interval[1] - interval[0]), rtol=1e-12)
    assert mean["dissipation"].attrs["units"] == "N" and "95 % confidence" in mean["dissipation_error"].attrs["long_name"]
    assert not any("_error_error" in name for name in mean.data_vars) and mean.attrs["mean_over"] == "friction%mu"
    assert len(lines(mean_over(table, "friction%mu"), "dissipation").collections) == 3
    dataset.write(mean, tmp_path / "mean.csv")
    assert "dissipation_error" in (tmp_path / "mean.csv").read_text()
    (tmp_path / "pad.nml").write_text(PAD)
    of_pads = mfv.study(tmp_path / "pad.nml", {"friction%mu": [0.1, 0.5, 0.65], "body(2)%radius": [127.0, 128.0]})
    mean = mean_over(of_pads, "friction%mu")  # with 0.1 it slides
    assert mean["realisations"].values.tolist() == [2, 2] and not flagged(mean, "normal_force").any()
    assert flagged(mean, "cycle_dissipation").all() and np.isfinite(mean["cycle_dissipation"]).all()
    mean = mean_over(mfv.study(tmp_path / "pad.nml", {"Q": PAD_FORCES}), "Q")  # one of them is not resolved
    assert flagged(mean, "cycle_dissipation") and not flagged(mean, "approach")
    assert str(mean["warnings"].values).startswith("1 of 3 realisations have warnings")
    for axis, words in (("friction%m", "did you mean friction%mu"), ("Q", "no axis 'Q'")):
        with pytest.raises(ValueError, match=words):
            mean_over(of_pads, axis)
    pairs = {"pair": {"friction%mu": [0.5, 0.65], "body(2)%radius": [127.0, 128.0]}}
    zipped = mfv.study(tmp_path / "pad.nml", pairs)
    of_all = mean_over(zipped, "pair")
    assert of_all["approach"].ndim == 0 and len(dataset.frame_of(of_all)) == 1
    with pytest.raises(ValueError, match="varies together with"):
        mean_over(zipped, "friction%mu")
    with pytest.raises(mfv.MfvError, match="between 0 and 1, not 95"):
        mean_over(of_pads, "friction%mu", 95)


def test_bars_that_cannot_be_are_explained(tmp_path):
    (tmp_path / "pad.nml").write_text(PAD)
    table = mfv.study(tmp_path / "pad.nml", {"friction%mu": [0.1, 0.65]}, error_estimate=True)
    assert flat(table, "outcome").tolist() == ["gross sliding", "complete"]
    assert flat(table, "error_estimate")[0].startswith("none: ") and flat(table, "error_estimate")[1] == "yes"
    assert np.isnan(flat(table, "approach_error")[0]) and flat(table, "approach_error")[1] > 0.0


def test_reference_is_full_coupling(study):
    folder, table = study
    there = (table["status"] == 0).values
    is_full = np.broadcast_to(table["scene%coupling"].values == "full", there.shape)
    for moment in MOMENTS:
        for traction in TRACTIONS:
            errors = table[f"{traction}_error_{moment}"].values
            assert all(errors[is_full & there] == 0) and all(errors[~is_full & there] > 0) and all(errors[there] < 1)
    dissipation = table["cycle_dissipation"]
    xarray.testing.assert_equal(table["dissipation_ratio"], dissipation / dissipation.sel({"scene%coupling": "full"}))
    # Eq. 6.6 by hand, from the whole results of two cases.
    planned = mfv.Study(folder / "base.nml", AXES)
    full, goodman = (mfv.run(text=planned.text(number)).steps[1] for number in (1, 2))
    for name in TRACTIONS:
        by_hand = np.abs(goodman[name] - full[name]).sum() / np.abs(full[name]).sum()
        np.testing.assert_allclose(flat(table, f"{name}_error_loading")[1], by_hand, rtol=1e-12)


def test_reference_is_a_finer_mesh(tmp_path):
    """Errors of coarser meshes against the finest fall as these get finer, about as fast as against the closed form."""
    nodes = [33, 65, 129, 513]
    table = mfv.study(write(tmp_path), {"mesh%nodes": nodes}, reference={"mesh%nodes": 513})
    errors = table["pressure_error_loading"].values
    assert errors[-1] == 0 and all(np.diff(errors) < 0) and errors[0] / errors[2] > 4
    reference = mfv.run(text=mfv.Study(tmp_path / "base.nml", {"mesh%nodes": nodes}).text(1))
    exact = reference.reference.pressure
    step = reference.steps[1]
    by_form = np.abs(step.pressure - exact).sum() / exact.sum()
    assert 0.2 < errors[0] / by_form < 5


def test_errors_do_not_depend_on_sides_and_units(tmp_path):
    """Random forces to the other side, and random units: the same differences from full coupling at every moment."""
    chance = np.random.default_rng(17)
    columns = ["dissipation_ratio", *(f"{traction}_error_{moment}" for moment in MOMENTS for traction in TRACTIONS)]
    for case in range(4):
        ratio, length, force = chance.uniform(0.2, 0.9), 10 ** chance.uniform(-3, 3), 10 ** chance.uniform(-3, 3)
        axes = {"scene%coupling": ["full", "goodman", "none"]}
        tables = []
        for side, unit, load in ((1, 1, 1), (-1, 1, 1), (1, length, force)):
            base = mfv.Scene.from_text(BASE.format(nodes=41, cycles=1), str(tmp_path / f"scene{case}"))
            base.lower.shear_modulus, base.lower.poisson_ratio = load / unit**2, 0.1
            base.upper.radius, base.mesh.half_width = 0.25 * unit, 0.01225 * unit
            base.steps[0].normal_force = 6e-4 * load / unit
            for step, sign in zip(base.steps[1:], (side, -side)):
                step.tangential_force, step.force_ratio = None, sign * ratio
            tables.append(mfv.study(base, axes, reference="full"))
        assert {outcome for table in tables for outcome in flat(table, "outcome")} == {"complete"}, flat(tables[0], "message")
        for name in columns:
            assert np.isfinite(tables[0][name]).all(), name
            for other in tables[1:]:
                np.testing.assert_allclose(other[name], tables[0][name], rtol=1e-7, atol=1e-9, err_msg=name)


def kept(pressure, interval=1.0, cycles=2.0, middle=0.0, cycle_dissipation=1.0):
    """A solved case with tractions on equal intervals."""
    pressure = np.array(pressure, dtype=float)
    numbers = [math.nan] * len(observables())
    for name, value in (("cycles", cycles), ("cycle_dissipation", cycle_dissipation)):
        numbers[list(observables()).index(name)] = value
    x = middle + interval * (np.arange(pressure.size) - 0.5 * (pressure.size - 1))
    arrays = dict(zip(OF_MESHES, (x, np.full(pressure.size, interval), np.array([interval]))))
    arrays |= {f"moments/{moment}/pressure": pressure for moment in MOMENTS}
    return Solved(0, "", observables=numbers, arrays=arrays)


@pytest.mark.parametrize(
    "one, other, error",
    [
        ([1.0, 2.0, 1.0], [1.0, 2.0, 1.0], 0.0),
        ([1.0, 3.0, 0.0], [1.0, 2.0, 1.0], 0.5),
        ([0.0, 1.0, 3.0, 1.0, 1.0], [1.0, 2.0, 1.0], 0.5),  # on a wider mesh: what is beyond the other counts
        ([2.0], [1.0, 2.0, 1.0], 0.5),
        ([1.0, 2.0, 1.0], [0.0, 0.0, 0.0], math.nan),
    ],
)
def test_errors_of_tractions(one, other, error):
    for moment in MOMENTS:
        np.testing.assert_equal(dataset._traction_error(kept(one), kept(other), moment, "pressure"), error)
    assert math.isnan(dataset._traction_error(kept(one), kept(other), "loading", "shear"))


def test_meshes_that_differ_are_compared_between_nodes():
    """A triangle on two meshes is one triangle; half of it is half away."""
    coarse, fine = kept([0, 1, 0], 1.0), kept([0, 0.5, 1, 0.5, 0], 0.5)
    assert dataset._traction_error(coarse, fine, "return", "pressure") == pytest.approx(0, abs=1e-15)
    assert dataset._traction_error(kept([0, 0.5, 0], 1.0), fine, "return", "pressure") == pytest.approx(0.5)
    even = kept([0, 1, 1, 0], 1.0)
    assert dataset._traction_error(even, kept([0, 1, 0], 1.0), "return", "pressure") == pytest.approx(1.0)


@pytest.mark.parametrize("cycles", [5.0, math.nan])
def test_no_comparison_of_other_cycles(cycles):
    one, other = kept([1, 2, 1], cycles=cycles), kept([1, 2, 2])
    assert dataset._traction_error(one, other, "loading", "pressure") == pytest.approx(0.2)
    for here, there in ((one, other), (other, one)):
        assert math.isnan(dataset._dissipation_ratio(here, there))
        assert all(math.isnan(dataset._traction_error(here, there, moment, "pressure")) for moment in MOMENTS[1:])
    assert dataset._dissipation_ratio(kept([1], cycle_dissipation=3.0), other) == 3.0


def test_moments_that_are_there(study):
    """Loading where cycles were begun, reversal and return where one is whole."""
    folder, _ = study
    wanted = [f"moments/{moment}/{traction}" for moment in MOMENTS for traction in TRACTIONS]
    shear = mfv.Axis(["step(3)%tangential_force"], [-2.8e-4, -8e-4])
    table = mfv.study(folder / "base.nml", {"shear": shear}, fields=[*wanted, "steps/0002/shear", "state/shear"])
    whole, begun = (table.isel(shear=place) for place in (0, 1))
    assert begun["outcome"] == "gross sliding"
    np.testing.assert_array_equal(whole["moments_loading_shear"], whole["steps_0002_shear"])
    np.testing.assert_array_equal(whole["moments_return_shear"], whole["state_shear"])
    np.testing.assert_allclose(
        whole["moments_reversal_shear"], -whole["moments_loading_shear"], atol=1e-9 * np.abs(whole["state_shear"]).max().item()
    )
    assert np.isfinite(begun["moments_loading_pressure"]).all() and np.isnan(begun["moments_return_pressure"]).all()
    pressed = mfv.Scene.from_file(folder / "base.nml")
    pressed.steps = pressed.steps[:2]
    assert not any(name.startswith("moments_") for name in mfv.study(pressed, fields=wanted).data_vars)


def test_fields_and_observables_on_request(study):
    folder, whole = study
    axes = {"mesh%nodes": [11, 21], "friction%mu": [0.5, 0.7]}
    table = mfv.study(folder / "base.nml", axes, observables=["shift"], fields=["state/pressure", "cycles/dissipation"])
    assert "shift" in table and "approach" not in table and "loss_factor" in whole
    assert table["state_pressure"].dims == ("mesh%nodes", "friction%mu", "node") and table.sizes["node"] == 21
    assert table["state_pressure"].attrs["units"] == "N/mm^2" and table["cycles_dissipation"].sizes["cycle"] == 1
    assert np.isnan(table["state_pressure"].sel({"mesh%nodes": 11})[:, 11:]).all()
    result = mfv.run(text=mfv.Study(folder / "base.nml", axes).text(4))
    np.testing.assert_array_equal(table["state_pressure"][1, 1], result.state.pressure)
    np.testing.assert_array_equal(table["mesh_x"][1, 1], result.mesh.x)
    with pytest.raises(mfv.errors.InputError, match="unknown observable 'shiftt'; choose from normal_force"):
        mfv.study(folder / "base.nml", axes, observables=["shiftt"])
    early = mfv.study(folder / "base.nml", {"friction%mu": [0.2]}, fields=["cycles/dissipation"])
    assert "cycles_dissipation" not in early and early["status"] != 0


def test_zipped_axes_and_tables_of_cases(study):
    folder, _ = study
    zipped = mfv.study(folder / "base.nml", {"pair": {"friction%mu": [0.5, 0.7], "mesh%nodes": [11, 21]}})
    assert dict(zipped.sizes) == {"pair": 2} and list(zipped["mesh%nodes"]) == [11, 21] and list(zipped["nodes"]) == [11, 21]
    frame = pandas.DataFrame({"friction%mu": [0.5, 0.7], "mesh%nodes": [11, 21]})
    rows = [{"friction%mu": 0.5, "mesh%nodes": 11}, {"friction%mu": 0.7, "mesh%nodes": 21}]
    for table in (frame, rows):
        solved = mfv.study(folder / "base.nml", table)
        assert dict(solved.sizes) == {"row": 2} and list(solved["case"]) == [1, 2]
        np.testing.assert_array_equal(solved["shift"], zipped["shift"])
    with pytest.raises(mfv.errors.InputError, match="mesh%nodes has 1 values, but friction%mu has 2"):
        mfv.study(folder / "base.nml", {"pair": {"friction%mu": [0.5, 0.7], "mesh%nodes": [11]}})
    for wrong in (3, [3], [{"a": 1}, {"b": 2}], {"friction%mu": 0.5}, {"friction%mu": "0.5"}):
        with pytest.raises(TypeError):
            mfv.study(folder / "base.nml", wrong)


def test_a_function_makes_scenes(study):
    folder, _ = study
    base = mfv.Scene.from_file(folder / "base.nml")

    def scene(point):
        base.friction.mu = point["grip"] / 1e-3
        base.mesh.nodes = 11 if point["is_coarse"] else 21
        return base

    made = mfv.study(scene, {"grip": [5e-4, 7e-4], "is_coarse": [True, False]})
    keyed = mfv.study(base, {"friction%mu": [0.5, 0.7], "mesh%nodes": [11, 21]})
    for name in ("shift", "cycle_dissipation", "events"):
        np.testing.assert_array_equal(made[name], keyed[name])
    assert made.attrs["length_unit"] == "mm" and list(made["grip"]) == [5e-4, 7e-4]


def test_a_function_with_keys_and_other_units(study):
    folder, _ = study
    base = mfv.Scene.from_file(folder / "base.nml")
    axes = {"nodes_wanted": mfv.Axis("mesh%nodes", [11, 21]), "kind": [(1, 2), [3]]}
    made = mfv.study(lambda point: base, axes)
    assert made["nodes"].values.tolist() == [[11, 11], [21, 21]] and list(made["kind"]) == [1, 2]

    def scene(point):
        base.length_unit = point["unit"]
        return base

    with pytest.raises(mfv.errors.InputError, match="case 2 \\(unit='m'\\): the units of the scene differ from those of case 1"):
        mfv.study(scene, {"unit": ["mm", "m"]})


def test_values_that_are_lists_paths_and_arrays(study, tmp_path):
    folder, _ = study
    grip = np.full(21, 0.7)
    weak = np.where(np.abs(np.arange(21) - 10) > 5, 0.7 - 1e-9, 0.7)
    planned = mfv.Study(folder / "base.nml", {"friction%mu": [grip, weak, list(0.5 * grip)]})
    table = planned.run()
    assert list(table["friction%mu"]) == [1, 2, 3] and len(set(flat(table, "cycle_dissipation"))) == 3
    dataset.write(table, tmp_path / "lists.nc")
    (tmp_path / "base.nml").write_text(BASE.format(nodes=21, cycles=1).replace("mu=0.7", "mu_file='mu.txt'"))
    axes, found = {"Friction%MU_file": [tmp_path / "mu.txt"], "mesh%nodes": np.array([21])}, []
    for edge in (0.7, 0.6):
        (tmp_path / "mu.txt").write_text(f"-1 {edge}\n1 0.7\n")
        found.append(mfv.study(tmp_path / "base.nml", axes, store=tmp_path / "s.sqlite")["cycle_dissipation"].item())
    assert found[0] != found[1]
    with pytest.raises(mfv.errors.InputError, match="is already varied"):
        mfv.Study(folder / "base.nml", {"body(2)%radius": [0.2], "Body(02)%Radius": [0.3]})


def test_what_is_no_study(study):
    folder, _ = study
    base = folder / "base.nml"
    for axes, kind, words in (
        ({3: [1]}, TypeError, "must be a key of the case such as 'friction%mu', not 3"),
        ({"a": mfv.Axis([], [1])}, mfv.errors.InputError, "no keys given"),
        ({"a": mfv.Axis("friction%mu", "full")}, TypeError, "a: must be a list of values"),
        ({"a": mfv.Axis("friction%mu", [0.3], 2)}, TypeError, "a: must be a list of values"),
        ({"a": mfv.Axis([3], [0.3])}, TypeError, "must be a key of the case"),
        ({"a": mfv.Axis("friction%mu", [[0.3]], [2])}, mfv.errors.InputError, "is not a number"),
        ({"p": {}}, mfv.errors.InputError, "p: no axes given"),
        ({"a/b": {"friction%mu": [0.5]}}, mfv.errors.InputError, "a name must be a non-empty text"),
        ({"case": {"friction%mu": [0.5]}}, mfv.errors.InputError, "case: this name is already in use"),
        (pandas.DataFrame(), mfv.errors.InputError, "must have rows"),
        ([], TypeError, "a table of cases"),
        ({"dundurs_beta": ["a"]}, mfv.errors.InputError, "must be a number from -0.5 to 0.5"),
    ):
        with pytest.raises(kind, match=words):
            mfv.study(base, axes)
    for wrong in ({"executor": None}, {"executor": 4}, {"reference": ["full"]}):
        with pytest.raises((TypeError, mfv.errors.InputError)):
            mfv.study(base, {"scene%coupling": ["full"]}, **wrong)
    with pytest.raises(mfv.errors.InputError, match="give a Scene, such as Scene.from_text\\(text\\)"):
        mfv.study(BASE.format(nodes=21, cycles=1), {"scene%coupling": ["full"]})
    with pytest.raises(mfv.errors.InputError, match="no base case given"):
        mfv.study([])
    with pytest.raises(mfv.errors.InputError, match="two bases have the name"):
        mfv.study([base, base])
    with pytest.raises(mfv.errors.InputError, match="state_pressure is a column of every study"):
        mfv.study(base, {"state_pressure": mfv.Axis("friction%mu", [0.5])}, fields="state/pressure")
    with pytest.warns(UserWarning, match="no case has the field 'state/presure'"):
        mfv.study(base, fields="state/presure")
    assert "shift" in mfv.study(base, observables="shift")


def test_several_bases(study, tmp_path):
    folder, _ = study
    (tmp_path / "other.nml").write_text(BASE.format(nodes=15, cycles=1))
    table = mfv.study([folder / "base.nml", tmp_path / "other.nml"], {"friction%mu": [0.5, 0.7]})
    assert dict(table.sizes) == {"base": 2, "friction%mu": 2} and table["nodes"].values.tolist() == [[21, 21], [15, 15]]
    (tmp_path / "metres.nml").write_text(BASE.format(nodes=15, cycles=1).replace("'mm'", "'m'"))
    with pytest.raises(mfv.errors.InputError, match="metres.nml: the units .* differ from those of .*base.nml"):
        mfv.Study([folder / "base.nml", tmp_path / "metres.nml"])
    alone = mfv.study(folder / "base.nml")
    assert dict(alone.sizes) == {"row": 1} and alone["outcome"] == "complete"
    assert list(dataset.frame_of(alone).columns[:3]) == ["case", "base", "outcome"]


def test_a_key_takes_the_place_of_its_alternatives(study):
    folder, _ = study
    for keys, values in (
        (["step(2)%force_ratio", "step(3)%force_ratio"], [0.4]),
        (["step(2)%shift", "step(3)%shift"], [1e-4]),
        (["step(1)%approach"], [1e-4]),
        (["body(1)%youngs_modulus"], [2.6]),
    ):
        factors = [1, -1][: len(keys)]
        planned = mfv.Study(folder / "base.nml", {"varied": mfv.Axis(keys, values, factors)})
        assert planned.run()["outcome"].item() in ("complete", "gross sliding"), planned.text(1)


def test_dundurs_beta_keeps_the_mutual_compliance(study):
    folder, _ = study
    table = mfv.study(
        folder / "base.nml", {"dundurs_beta": [-0.5, -0.2, 0.0, 0.5]}, fields=["scene/dundurs_beta", "scene/contact_modulus"]
    )
    np.testing.assert_allclose(table["scene_dundurs_beta"], [-0.5, -0.2, 0.0, 0.5], atol=1e-15)
    np.testing.assert_allclose(table["scene_contact_modulus"], 1.0 / 0.7, rtol=1e-14)
    with pytest.raises(mfv.errors.InputError, match="dundurs_beta=0.6: must be a number from -0.5 to 0.5"):
        mfv.study(folder / "base.nml", {"dundurs_beta": [0.0, 0.6]})


@pytest.mark.parametrize(
    "axes, words",
    [
        ({"friction%my": [1]}, "'friction%my': unknown key of &friction; did you mean mu?"),
        ({"frictoin%mu": [1]}, "unknown group; did you mean friction?"),
        ({"mu": [1]}, "'mu': must be 'group%key', 'group\\(number\\)%key' or 'dundurs_beta'"),
        ({"step%shift": [1]}, "which &step\\?"),
        ({"step(4)%shift": [1]}, "no &step 4 in .*base.nml, which has 3"),
        ({"output%file": ["a"]}, "the study names the result files"),
        (
            {"friction%mu": [0.3, -0.7]},
            "case 2 \\(base=.*, friction%mu=-0.7\\): .*base.nml:6: &friction mu=-0.7: must be a number at least 0",
        ),
        ({"scene%coupling": ["gudman"]}, "must be 'full', 'goodman' or 'none'"),
        ({"shift": mfv.Axis("friction%mu", [0.3])}, "shift is a column of every study; choose another name"),
        (
            {"a/b": mfv.Axis("friction%mu", [0.3])},
            "a name must be a non-empty text without / and without blanks at either end",
        ),
        ({"a": mfv.Axis("friction%mu", [0.3], [1, -1])}, "must have one value per key \\(1\\), not 2"),
        ({"a": mfv.Axis("scene%coupling", ["full"], [2])}, "'full' is not a number and cannot be multiplied by 2"),
        ({"a": mfv.Axis("friction%mu", [1e300], [1e300])}, "1e\\+300 times 1e\\+300 overflows"),
        ({"friction%mu": []}, "no values given"),
        ({"friction%mu": [0.5], "b": mfv.Axis("friction%mu", [0.5])}, "'friction%mu' is already varied"),
        ({"step(2)%shift": [1e-4], "step(2)%force_ratio": [0.5]}, "'step\\(2\\)%force_ratio' is already varied"),
        ({"dundurs_beta": [0.1], "body(2)%rigid": [False]}, "cannot be varied in one study"),
    ],
)
def test_what_cannot_be_varied(axes, words, study):
    with pytest.raises(mfv.errors.InputError, match=words):
        mfv.study(study[0] / "base.nml", axes)


def test_references_that_are_not_there(study):
    for reference in ("full", {"mesh%nodes": 7}, {"friction%mu": 0.5, "mesh%nodes": 11}):
        with pytest.raises(mfv.errors.InputError, match="reference"):
            mfv.study(study[0] / "base.nml", {"mesh%nodes": [11, 21]}, reference=reference)


def test_values_that_do_not_go_together_are_there(study):
    axes = {"solver%algorithm": ["mfv", "conventional"], "solver%stepping": ["auto", "nominal"]}
    table = mfv.study(study[0] / "base.nml", axes)
    assert list(flat(table, "outcome")[[0, 1, 3]]) == ["complete", "complete", "input error"]
    assert "has no effect with algorithm='conventional'" in flat(table, "message")[3]
    assert (
        np.isnan(flat(table, "normal_force")[3]) and np.isnan(flat(table, "largest_residual")[3]) and flat(table, "nodes")[3] == 0
    )
    assert table.attrs["cases_input_error"] == 1


def test_arrays_in_place_of_files_and_files_beside_the_base(study, tmp_path):
    folder, _ = study
    x = np.linspace(-0.02, 0.02, 41)
    base = mfv.Scene.from_file(folder / "base.nml")
    base.upper = mfv.Body(shape="profile", rigid=True, data={"x": x, "height": x**2 / 0.5})
    in_memory = mfv.study(base, {"step(1)%normal_force": [5e-4, 1e-3]})
    np.savetxt(tmp_path / "profile.txt", np.column_stack([x, x**2 / 0.5]))
    text = BASE.format(nodes=21, cycles=1).replace("shape='disk', radius=0.25", "shape='profile', file='profile.txt'")
    (tmp_path / "base.nml").write_text(text)
    from_file = mfv.study(tmp_path / "base.nml", {"step(1)%normal_force": [5e-4, 1e-3]})
    assert set(flat(in_memory, "outcome")) == {"complete"}
    np.testing.assert_allclose(in_memory["shift"], from_file["shift"], rtol=1e-12)


def test_whole_results(study, tmp_path):
    folder, _ = study
    table = mfv.study(folder / "base.nml", AXES, results=tmp_path / "results", workers=3)
    names = flat(table, "result_file")
    assert len(set(names)) == CASES == len(list((tmp_path / "results").iterdir())) and names[0].startswith(str(tmp_path))
    alone = mfv.run(text=mfv.Study(folder / "base.nml", AXES).text(14))
    with h5py.File(tmp_path / names[13]) as result:
        np.testing.assert_array_equal(result["state/pressure"], alone.state.pressure)
        assert result["summary/shift"][()] == flat(table, "shift")[13]


def test_matrices_are_read_by_threads_side_by_side(tmp_path):
    x = np.linspace(-1.0, 1.0, 21)
    with h5py.File(tmp_path / "body.h5", "w") as file:
        file["x"] = x
        file["compliance"] = np.exp(-np.abs(x[:, None] - x))  # positive definite
    (tmp_path / "base.nml").write_text(
        "&body shape='matrix', file='body.h5' /\n&body shape='disk', radius=2.0, rigid=.true. /\n&step normal_force=0.1 /\n"
    )
    forces = np.linspace(0.01, 0.1, 40)
    tables = [
        mfv.study(tmp_path / "base.nml", {"step(1)%normal_force": forces}, results=tmp_path / "results", workers=workers)
        for workers in (4, 1)
    ]
    assert set(flat(tables[0], "outcome")) == {"complete"}
    np.testing.assert_allclose(tables[0]["normal_force"], forces, rtol=1e-12)
    xarray.testing.assert_identical(*tables)
    with pytest.raises(mfv.errors.InputError, match="dundurs_beta needs bodies with materials, not shape='matrix'"):
        mfv.study(tmp_path / "base.nml", {"dundurs_beta": [0.1]})


def test_files_are_read_back_identical(study, tmp_path):
    _, table = study
    for name in ("table.nc", "table.h5"):
        dataset.write(table, tmp_path / name)
        with xarray.open_dataset(tmp_path / name, engine="h5netcdf") as read:
            xarray.testing.assert_identical(read.load(), table)
    dataset.write(table, tmp_path / "table.csv")
    frame = pandas.read_csv(tmp_path / "table.csv")
    assert list(frame.columns[:7]) == ["case", "base", "friction%mu", "Q [N/mm]", "scene%coupling", "outcome", "status"]
    assert len(frame) == CASES and list(frame["case"]) == list(range(1, CASES + 1))
    np.testing.assert_array_equal(frame["shift [mm]"], flat(table, "shift"))
    np.testing.assert_array_equal(frame["cycle_dissipation [N]"], flat(table, "cycle_dissipation"))


def test_cases_have_one_datum():
    """The approach of a power of 2 over the force: a^2/(2R) [ln(2D/a) + 1/2] with the largest default datum (Johnson 1985)."""
    lower, upper = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.power(0.05, 2.0, rigid=True)
    mesh, forces = mfv.Mesh(nodes=201), np.array([0.005, 0.04, 0.01])
    half_widths = np.sqrt(4.0 * forces * 10.0 * 0.7 / (2.0 * np.pi))

    def made(point):
        return mfv.Scene(lower, upper, mesh=mesh, coupling="none", steps=[mfv.Step(normal_force=point["step(1)%normal_force"])])

    expected = mfv.reference.power_approach(half_widths, 0.05, 2.0, half_widths.max())
    for base in (made, made({"step(1)%normal_force": 0.02})):
        planned = mfv.Study(base, {"step(1)%normal_force": forces})
        np.testing.assert_allclose(planned.run().approach, expected, rtol=2e-3)
        assert "datum" in planned.text(3) and "give datum" not in mfv.run(text=planned.text(3)).attributes["warnings"]
    given = mfv.study(base, {"step(1)%normal_force": forces[:1], "body(1)%datum": [1.0, 2.0]}).approach.values.ravel()
    expected = [mfv.reference.power_approach(half_widths[0], 0.05, 2.0, datum) for datum in (1.0, 2.0)]
    np.testing.assert_allclose(given, expected, rtol=2e-3)
