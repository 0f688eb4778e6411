"""Maps of regimes against closed forms: boundaries, columns, flags; the command; restarts; messages."""

import itertools

import numpy as np
import pytest
import small
import xarray

import mfv
from mfv import fatigue
from mfv.commands import main
from mfv.errors import InputError
from mfv.fatigue import comparison
from mfv.studies import boundaries, flagged, plan, regime_map
from mfv.studies.dataset import frame_of, write
from mfv.studies.map_figure import figure
from mfv.studies.maps import polygons

MU, P = 0.7, 1.0e-3
HEAD = """&scene coupling='none', length_unit='mm', force_unit='N' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3{strength} /
&body {upper}, rigid=.true. /
&mesh nodes={nodes} /
&friction law='coulomb', mu=0.7 /
"""
CYLINDER, PUNCH = "shape='disk', radius=0.25", "shape='flat_punch', half_width=0.4"
SHEARED = "&step normal_force=1e-3, friction=.false. /\n&step force_ratio=0.4 /\n&step force_ratio=-0.4, cycles=1 /\n"


def case(folder, steps=SHEARED, upper=CYLINDER, nodes=41, strength=""):
    path = folder / "case.nml"
    path.write_text(HEAD.format(upper=upper, nodes=nodes, strength=strength) + steps)
    return path


def boundary(table, name):
    """Both axes along a boundary, and the tolerance."""
    here = table.isel(crossing=table["boundary"].values == name)
    return (*(here[f"boundary_{axis}"].values for axis in table.attrs["map_axes"]), here["boundary_tolerance"].values)


@pytest.fixture(scope="module")
def cylinder(tmp_path_factory):
    """A map of Cattaneo and Mindlin's problem over forces, stick where the stick ratio is above 0.8."""
    return regime_map(case(tmp_path_factory.mktemp("cylinder"), nodes=101), points=(9, 7), stick_ratio=0.8)


def test_sliding_begins_at_mu_p(cylinder):
    assert cylinder.attrs["map_axes"] == ["Q", "P"]
    q, p, tolerance = boundary(cylinder, "gross sliding")
    assert q.size > 8
    assert np.abs(q / (MU * p) - 1.0).max() < 1.0e-6
    assert (tolerance <= 1.0e-6 * np.maximum(q, p)).all()
    slides = cylinder["Q"] > MU * cylinder["P"]
    assert ((cylinder["regime"] == "gross sliding") == slides).all()


def test_stick_zones_of_mindlin_have_the_given_width(cylinder):
    q, p, _ = boundary(cylinder, "stick")
    # c/a = sqrt(1 - Q/(mu P)).
    assert q / (MU * p) == pytest.approx(np.full(q.size, 1.0 - 0.8**2), rel=0.01)
    assert ((cylinder["regime"] == "stick") == (cylinder["smallest_stick_ratio"] >= 0.8)).all()


def test_grid_is_the_table_of_a_study(cylinder, tmp_path):
    q, p = float(cylinder["Q"][3]), float(cylinder["P"][4])
    here = cylinder.sel(Q=q, P=p)
    steps = [mfv.Step(normal_force=p, friction=False), mfv.Step(tangential_force=q), mfv.Step(tangential_force=-q, cycles=1)]
    alone = mfv.Scene.from_text((HEAD + SHEARED).format(upper=CYLINDER, nodes=101, strength=""))
    alone.steps = steps
    assert alone.run().observables.cycle_dissipation == pytest.approx(float(here["cycle_dissipation"]), rel=1e-12)
    write(cylinder, tmp_path / "map.nc")
    with xarray.open_dataset(tmp_path / "map.nc") as again:
        assert list(again.attrs["map_axes"]) == ["Q", "P"]
        assert polygons(again.load(), "gross sliding") == polygons(cylinder, "gross sliding")
    assert len(frame_of(cylinder)) == 63


def test_points_of_a_curve_are_in_order(cylinder):
    for name in ("gross sliding", "stick"):
        q, p, _ = boundary(cylinder, name)
        assert (np.diff(p) > 0).all() or (np.diff(p) < 0).all()
        assert (np.diff(q) > 0).all() or (np.diff(q) < 0).all()


def test_fills_end_at_the_boundary(cylinder):
    """The area of gross sliding below Q = mu P, exactly."""
    area = 0.0
    for polygon in polygons(cylinder, "gross sliding"):
        x, y = np.array(polygon).T
        area += 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1)))
    q, p = cylinder["Q"].values, cylinder["P"].values
    lowest, corner = MU * p[0], q[-1] / MU
    assert area == pytest.approx(0.5 * (q[-1] - lowest) * (corner - p[0]), rel=1e-5)


def test_a_sharp_punch_sticks_until_it_slides(tmp_path):
    table = regime_map(case(tmp_path, upper=PUNCH), {"Q": (0.3 * MU * P, 1.1 * MU * P), "P": (0.5 * P, P)}, (4, 3))
    assert set(table["regime"].values.flat) == {"stick", "gross sliding"}
    for name in ("stick", "gross sliding"):
        q, p, _ = boundary(table, name)
        assert np.abs(q / (MU * p) - 1.0).max() < 1.0e-6


def test_forces_that_change_together_stick_below_mu(tmp_path):
    """Under P and Q in phase the steady state is full stick as long as |dQ/dP| < mu (Mindlin and Deresiewicz 1953)."""
    steps = "&step normal_force=1e-3 /\n&step normal_force=1.2e-3, tangential_force=1e-4 /\n&step normal_force=1e-3, tangential_force=0, cycles=2 /\n"
    limit = MU * 0.2e-3
    table = regime_map(case(tmp_path, steps, nodes=101), {"Q": (0.5 * limit, 1.5 * limit), "friction%mu": (0.7, 0.8)}, (4, 2))
    ratio = table["Q"] / (table["friction%mu"] * 0.2e-3)
    assert ((table["regime"] == "stick") == (ratio < 1.0)).all()
    q, mu, _ = boundary(table, "stick")
    assert q / (mu * 0.2e-3) == pytest.approx(np.ones(q.size), rel=1e-3)


def test_yielding_begins_as_in_hertz(tmp_path):
    strength = 0.04
    steps = "&step normal_force=2e-3, friction=.false. /\n&step tangential_force=1e-5 /\n&step tangential_force=-1e-5, cycles=1 /\n"
    path = case(tmp_path, steps, nodes=201, strength=f", yield_strength={strength}")
    table = regime_map(path, {"Q": (0.0, 1e-5), "P": (1e-3, 4e-3)}, (2, 4), tolerance=1e-5)
    q, p, tolerance = boundary(table, "yielding")
    (first,) = p[q == 0.0]
    modulus = 2.0 * 1.3
    half_width = 0.5 * 0.25 * float(mfv.reference.yield_contact_arc(modulus, 0.3, strength))
    assert first == pytest.approx(np.pi * half_width**2 * modulus / 0.91 / (4.0 * 0.25), rel=2e-3)
    assert (tolerance <= 1e-5 * p).all()
    assert ((table["yields"] == 1) == (table["largest_lower_von_mises"] >= strength)).all()


def test_sliding_under_a_prescribed_shift(tmp_path):
    """Under a shift the cases go on sliding; that at which it begins is found from the force, which stays mu P beyond it."""
    steps = "&step normal_force=1e-3, friction=.false. /\n&step shift=1e-3 /\n&step shift=-1e-3, cycles=1 /\n"
    table = regime_map(case(tmp_path, steps), {"D": (2e-4, 2e-3), "P": (8e-4, 1e-3)}, (5, 2), tolerance=1e-5)
    slides = table["regime"] == "gross sliding"
    assert slides.any() and (table["outcome"] == "complete").all()
    assert (slides == (table["force_amplitude"] > MU * table["P"] * (1.0 - 1e-9))).all()
    for shift, force, tolerance in zip(*boundary(table, "gross sliding")):
        near = mfv.Scene.from_text((HEAD + steps).format(upper=CYLINDER, nodes=41, strength=""))
        amplitudes = []
        for factor in (1.0 - 1e-4, 1.0 + 1e-4):
            near.steps = [
                mfv.Step(normal_force=force, friction=False),
                mfv.Step(shift=factor * shift),
                mfv.Step(shift=-factor * shift, cycles=1),
            ]
            amplitudes.append(near.run().observables.smallest_stick_ratio)
        assert amplitudes[0] > 0.0 == amplitudes[1]
        assert tolerance < 1e-4 * shift


def test_open_contact(tmp_path):
    steps = "&step approach=1e-4 /\n&step shift=2e-5 /\n&step shift=-2e-5, cycles=1 /\n"
    table = regime_map(case(tmp_path, steps), {"step(1)%approach": (-2e-4, 1e-4), "D": (1e-5, 3e-5)}, (4, 2))
    assert ((table["regime"] == "open") == (table["step(1)%approach"] <= 0.0)).all()
    approach, _, tolerance = boundary(table, "open")
    assert (np.abs(approach) <= tolerance).all() and tolerance.max() <= 1e-10


def test_solved_cases_are_reused(tmp_path, monkeypatch):
    path, store = case(tmp_path), tmp_path / "map.sqlite"
    one = regime_map(path, points=4, store=store)
    monkeypatch.setattr(plan.executors, "solve_all", lambda *_: pytest.fail("a case was solved again"))
    assert regime_map(path, points=4, store=store).identical(one)


def test_wear_rate_is_the_worn_area(tmp_path):
    path = case(tmp_path, SHEARED + "&wear coefficient=1e-9 /\n")
    table = regime_map(path, points=3, contour="wear_rate")
    worn = table["worn_area"].where(table["outcome"] == "complete")
    assert worn.count() > 2
    assert (np.abs(table["wear_rate"] / worn - 1.0).fillna(0.0) < 1e-3).all()
    assert regime_map(case(tmp_path), points=2, wear_coefficient=1e-9)["wear_rate"].attrs["units"] == "mm^2"


@pytest.fixture
def pad(tmp_path):
    """A fretting pad, and a table with its material."""
    (tmp_path / "pad.nml").write_text(small.PAD)
    text = comparison.template().replace("70000", "74100")
    (tmp_path / "tests.csv").write_text(text)
    return tmp_path / "pad.nml", tmp_path / "tests.csv"


def test_life_at_the_largest_tension(pad):
    path, tests = pad
    material = comparison.read_tests(tests)[0]
    table = regime_map(path, {"Q": (100.0, 200.0), "P": (400.0, 600.0)}, 2, contour="life", material=material)
    scene = mfv.Scene.from_file(path)
    scene.steps = [
        mfv.Step(normal_force=600.0, friction=False),
        mfv.Step(tangential_force=200.0),
        mfv.Step(tangential_force=-200.0, cycles=1),
    ]
    result = scene.run()
    cycle = fatigue.stress_cycle(result, float(result.observables.largest_lower_tension_x), 0.0)
    expected = comparison.lives_of(material, cycle)["Smith-Watson-Topper"]
    assert float(table["life"].sel(Q=200.0, P=600.0)) == pytest.approx(expected, rel=1e-9)
    assert (table["life_solved"] == 1).all()


def test_lives_between_are_interpolated(pad, monkeypatch):
    path, tests = pad
    arguments = {"contour": "life", "material": comparison.read_tests(tests)[0]}
    fine = regime_map(path, {"Q": (120.0, 140.0), "P": (400.0, 600.0)}, 3, **arguments)
    monkeypatch.setattr("mfv.studies.maps.LIVES", 2)
    coarse = regime_map(path, {"Q": (120.0, 140.0), "P": (400.0, 600.0)}, 3, **arguments)
    assert int(coarse["life_solved"].sum()) == 4
    assert (coarse["life"].where(coarse["life_solved"], fine["life"]) == fine["life"]).all()
    assert (np.abs(coarse["life"] / fine["life"] - 1.0) < 0.05).all()


def test_flags_are_hollow_markers(tmp_path):
    table = regime_map(case(tmp_path, nodes=31), points=5)
    shown = flagged(table, "cycle_dissipation") & (table["outcome"] == "complete")
    assert shown.any()
    (axes,) = figure(table).axes
    (markers,) = (line for line in axes.lines if line.get_label().startswith("in doubt"))
    assert len(markers.get_xdata()) == int(shown.sum())
    assert markers.get_markerfacecolor() == "white"
    assert {text.get_text() for text in axes.texts} >= {"partial slip", "gross sliding"}


def test_loads_of_a_file(tmp_path):
    """A history in a file is scaled like steps."""
    (tmp_path / "loads.csv").write_text("# two rows\nNormal_force, tangential_force\n1e-3, 2e-4\n1e-3, -2e-4\n")
    path = case(tmp_path, "&step normal_force=1e-3, friction=.false. /\n&history file='loads.csv', cycles=2 /\n")
    table = regime_map(path, points=3)
    q, p, _ = boundary(table, "gross sliding")
    assert np.abs(q / (MU * p) - 1.0).max() < 2.0e-6


def test_bisection_and_secant_need_few_rounds():
    def count(function, is_smooth):
        solved = []

        def solve(points, _):
            solved.extend(points)
            return [boundaries.Sample(function(x), is_smooth) for x, _ in points]

        ends = [boundaries.Sample(function(x), is_smooth) for x in (1.0, 2.0)]
        one = boundaries.Crossing("any", 0, (0, 0), 0.0, 1.0, 2.0, *ends)
        boundaries.refine([one], solve, 1e-9)
        return one, len(solved)

    bisected, many = count(lambda x: 1.0 if x**3 > 3.0 else -1.0, False)
    secant, few = count(lambda x: x**3 - 3.0, True)
    for one in (bisected, secant):
        assert abs(one.value - 3.0 ** (1 / 3)) <= one.tolerance <= 1e-9 * 2.0
    assert few < 16 < many < 40


def test_curves_join_their_points():
    assert boundaries.curves([(1, 2), (3, 2), (3, 4)]) in ([[1, 2, 3, 4]], [[4, 3, 2, 1]])
    (closed,) = boundaries.curves([(0, 1), (1, 2), (2, 0)])
    assert closed[0] == closed[-1] and set(closed) == {0, 1, 2}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"over": ("Q",)}, "a map needs two different axes"),
        ({"over": ("Q", "D")}, "case.nml: D: the case gives no shift; it has Q, P"),
        ({"over": ("Q", "friction%my")}, "did you mean friction%mu?"),
        ({"over": ("Q", "friction%law")}, "friction%law='coulomb': an axis of a map needs a number"),
        ({"over": {"Q": (2e-4, 1e-4), "P": None}}, "Q: needs at least 2 points from a smaller to a larger"),
        ({"points": 1}, "Q: needs at least 2 points"),
        ({"contour": "cycle_disipation"}, "did you mean cycle_dissipation?"),
        ({"contour": "wear_rate"}, "add &wear coefficient"),
        ({"contour": "life"}, "--material"),
        ({"wear_coefficient": 1.0, "over": {"Q": None, "friction%mu": None}, "contour": "dissipation_"}, "not a column of a map"),
        ({"stick_ratio": 1.5}, "stick_ratio=1.5: must be above 0 and at most 1"),
        ({"wear_coefficient": -1.0}, "wear_coefficient=-1: must be above 0"),
    ],
)
def test_messages(tmp_path, arguments, words):
    with pytest.raises(InputError) as error:
        regime_map(case(tmp_path), **arguments)
    assert words in error.value.message


def test_material_of_another_body_is_refused(pad):
    path, tests = pad
    material = comparison.read_tests(tests)[0]
    path.write_text(small.PAD.replace("74100", "200000"))
    with pytest.raises(InputError, match="the material is not that of the lower body"):
        regime_map(path, points=2, material=material)
    path.write_text(small.PAD + "&layer body=1, thickness=0.02, youngs_modulus=3e5, poisson_ratio=0.2 /\n")
    with pytest.raises(InputError, match="a lower body without layers"):
        regime_map(path, points=2, material=material)
    path.write_text(small.PAD.replace("'mm'", "'m'"))
    with pytest.raises(InputError, match="in mm and N"):
        regime_map(path, points=2, material=material)
    with pytest.raises(InputError, match="parameter 'Miner'"):
        regime_map(path, points=2, material=material, parameter="Miner")


def test_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case(tmp_path, nodes=31)
    assert main(["map", "case.nml", "--over", "Q=1e-4:8e-4,P", "--points", "5x4", "-o", "map.svg"]) in (0, None)
    told = capsys.readouterr().out
    assert "20 points: " in told and "boundary of gross sliding: " in told and "within" in told
    assert told.splitlines()[-2:] == ["map.nc", "map.svg"]
    assert (tmp_path / "map.svg").read_text().startswith("<?xml")
    assert main(["plot", "map.nc", "--column", "largest_pressure", "-o", "pressure.png"]) == 0
    (tmp_path / "map.nc").write_text("mine")
    assert main(["map", "case.nml", "-o", "map.png"]) == 2
    assert "not overwritten" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--over", "Q"], "must be two axes with a comma between"),
        (["--over", "Q=1,P"], "a range is FROM:TO"),
        (["--points", "1x5"], "at least 2 with x between"),
        (["--stick-ratio", "0"], "stick_ratio=0: must be above 0"),
    ],
)
def test_command_refuses(tmp_path, monkeypatch, capsys, words, told):
    monkeypatch.chdir(tmp_path)
    case(tmp_path)
    try:
        code = main(["map", "case.nml", *words])
    except SystemExit as end:
        code = end.code
    assert code == 2
    assert told in capsys.readouterr().err


def test_examples_need_no_options(tmp_path, monkeypatch):
    """Every example with cycles of a tangential force has a default map."""
    monkeypatch.chdir(tmp_path)
    for name in ("mindlin", "fretting_pad", "cycles", "waves"):
        table = regime_map(small.ROOT / f"examples/{name}.nml", points=2)
        assert "failed" not in set(itertools.chain(table["regime"].values.flat))
