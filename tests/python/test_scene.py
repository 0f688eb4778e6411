"""Scenes in Python: they have the keys of the library, run like their texts, and take arrays in place of files."""

from __future__ import annotations

import copy
import dataclasses
import os
import pickle
import re
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from scenes import DISK, HALF_PLANE, MESH, PRESS, PROJECT, cylinder

import mfv
from mfv import errors

EXAMPLES = sorted(path for path in (PROJECT / "examples").glob("*.nml") if "&sweep" not in path.read_text())


def test_the_keys_of_a_scene_are_those_of_the_library() -> None:
    program = os.environ.get("MFV_RUN", str(PROJECT / "build/release/bin/mfv_run"))
    printed = subprocess.run([program, "--keys"], capture_output=True, text=True, check=True, timeout=60).stdout
    first, *_ = printed.partition("### &scene")[2].split("###")
    assert mfv.Scene.key_names() == re.findall(r"^\| `(\w+)`", first, re.MULTILINE)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_read_and_written_is_the_same_scene(path: Path) -> None:
    scene = mfv.Scene.from_file(path)
    assert scene.name == str(path)
    assert mfv.Scene.from_text(scene.text(), str(path)) == scene


@pytest.mark.parametrize("name", ["mindlin", "rough_punch", "weakening", "pin_in_bore"])
def test_a_scene_runs_with_the_digits_of_its_file(name: str) -> None:
    path = PROJECT / "examples" / f"{name}.nml"
    ran, expected = mfv.Scene.from_file(path).run(), mfv.run(path)
    assert ran.outcome == expected.outcome == "complete"
    for quantity in expected.state:
        np.testing.assert_array_equal(ran.state[quantity], expected.state[quantity])


def test_a_scene_by_hand_is_that_of_its_text() -> None:
    scene = cylinder(PRESS, mfv.Step(tangential_force=2.8e-4), title="O'Hara's", solver=mfv.Solver(linear_solver="dgesv"))
    text = """
      &scene title="O'Hara's", coupling='Goodman' /
      &body shape='half_plane', shear_modulus=1, poisson_ratio=3D-1 / ! below
      &body shape='disk', radius=0.25, rigid=T /
      &mesh nodes=61, half_width=0.01225 /
      &friction law='coulomb', mu=0.7 /
      &step normal_force=1.0e-3, friction=.false. /
      &step tangential_force=2.8e-4 /
      &solver linear_solver='dgesv' /
    """.replace("Goodman", "goodman")
    assert mfv.Scene.from_text(text) == scene
    assert scene.run().state.shear.tobytes() == mfv.run(text=text).state.shear.tobytes()


def test_constructors_give_the_keys() -> None:
    assert mfv.Body.half_plane(youngs_modulus=2.6, poisson_ratio=0.3).keys() == {
        "shape": "half_plane",
        "youngs_modulus": 2.6,
        "poisson_ratio": 0.3,
    }
    assert mfv.Body.disk(0.25, rigid=True) == mfv.Body(shape="disk", radius=0.25, rigid=True)
    assert mfv.Body.hole(2.0, shear_modulus=1.0, kernel="fourier", harmonics=64).keys()["harmonics"] == 64
    assert mfv.Body.flat_punch(0.4) == mfv.Body(shape="flat_punch", rigid=True, half_width=0.4)
    assert mfv.Friction.coulomb(0.5).keys() == {"law": "coulomb", "mu": 0.5}
    assert mfv.Friction.static_kinetic(0.7, 0.5).keys() == {
        "law": "static_kinetic",
        "mu_static": 0.7,
        "mu_kinetic": 0.5,
    }
    assert mfv.Friction.weakening(0.7, 0.5, 1e-5).weakening_distance == 1e-5
    assert mfv.Friction.dahl(0.7, 1.0e3, exponent=2.0).keys() == {
        "law": "dahl",
        "mu": 0.7,
        "stiffness": 1.0e3,
        "exponent": 2.0,
    }


def test_keys_are_given_by_name_and_only_those_there_are() -> None:
    with pytest.raises(TypeError, match="Body has no 'radiuss'; did you mean radius?"):
        mfv.Body(shape="disk", radiuss=0.25)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="Body has no 'youngs_moduls'; did you mean youngs_modulus?"):
        mfv.Body.disk(50.0, youngs_moduls=1.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="Scene has no 'sovler'; did you mean solver?"):
        mfv.Scene(DISK, DISK, sovler=None)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="Step has no 'xyz'; choose from normal_force, approach"):
        dataclasses.replace(PRESS, xyz=1.0)
    with pytest.raises(AttributeError, match="Step has no 'normal_froce'; did you mean normal_force?"):
        PRESS.normal_froce = 1.0
    with pytest.raises(AttributeError, match="Scene has no 'step'; did you mean steps?"):
        cylinder().step = PRESS


def test_the_library_judges() -> None:
    for scene, message in (
        (cylinder(mfv.Step(normal_force=-1.0)), r"scene: &step 1 normal_force=-1: must be a number at least 0"),
        (cylinder(mfv.Step(normal_force=float("nan"))), r"scene: 'step\(1\)%normal_force': the value is not finite"),
        (cylinder(mesh=mfv.Mesh(nodes=10**12)), "nodes=1e12: must be a whole number from 1 to 100000000"),
        (cylinder(mesh=mfv.Mesh(nodes=61.5)), "nodes=61.5: must be a whole number"),
        (cylinder(friction=mfv.Friction.coulomb([])), r"'friction%mu': no values are given"),
        (cylinder(friction=mfv.Friction(law="koulomb")), "law='koulomb'"),
        (mfv.Scene(DISK, DISK), "rigid"),
        (cylinder(title="two\nlines"), r"'scene%title': a text must not contain a line break"),
    ):
        with pytest.raises(errors.InputError, match=message):
            scene.contact()
    with pytest.raises(errors.InputError, match="not finite"):
        cylinder(mfv.Step(shift=float("inf"))).text()
    with pytest.raises(errors.InputError, match="hand.nml: &body"):
        mfv.Scene(DISK, DISK, name="hand.nml").run()
    empty = cylinder(PRESS)
    empty.steps = []
    with pytest.raises(errors.InputError, match="scene: at least one step is needed"):
        empty.run()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "&body shape='disk', radiuss=3 / &body shape='half_plane' /",
            "text:1: &body radiuss=3: unknown key; did you mean radius?",
        ),
        ("&body shape='disk', radius=3 /\n&mesh nodes=11 /\n&mesh nodes=13 /", "text:3: &mesh"),
        ("&body shape='disk', radius=3, radius=4 / &body shape='half_plane' /", "radius"),
        ("&body shape='disk', radius=1_0 / &body shape='half_plane' /", "radius=1_0"),
        ("&body shape='disk', radius=3 /", "&body"),
        ("&boddy shape='disk' /", "boddy"),
        ("body shape='disk' /", "is outside a group"),
    ],
)
def test_a_bad_text_is_told_of_by_the_library(text: str, message: str) -> None:
    with pytest.raises(errors.InputError, match=re.escape(message)):
        mfv.Scene.from_text(text)


def test_values_of_a_wrong_kind_are_told_of() -> None:
    with pytest.raises(TypeError, match=r"mesh%nodes: must be a text, a truth value, a number or an array, not \{1\}"):
        cylinder(mesh=mfv.Mesh(nodes={1})).text()  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"upper body: x must have one or two dimensions, not the shape \(0,\)"):
        mfv.Scene(HALF_PLANE, mfv.Body.profile([], [], rigid=True)).text()
    with pytest.raises(FileNotFoundError):
        mfv.Scene.from_file("no_such_file.nml")
    with pytest.raises(TypeError, match="takes either"):
        mfv.run(cylinder(PRESS), text="&scene /")


def test_parts_of_a_wrong_class_are_told_of() -> None:
    for keys, message in (
        ({"friction": "coulomb"}, r"friction of a Scene must be a mfv.Friction, such as Friction.coulomb\(0.7\), not 'coulomb'"),
        ({"mesh": 101}, "mesh of a Scene must be a mfv.Mesh, .* not 101"),
        ({"steps": [PRESS, {"normal_force": 1.0}]}, r"steps\[1\] of a Scene must be a mfv.Step"),
    ):
        with pytest.raises(TypeError, match=message):
            mfv.Scene(HALF_PLANE, DISK, **keys)  # type: ignore[arg-type]
    scene = cylinder(PRESS)
    scene.upper = "disk"  # type: ignore[assignment]
    with pytest.raises(TypeError, match="upper of a Scene must be a mfv.Body"):
        scene.run()


def test_bodies_can_be_subclassed() -> None:
    class Steel(mfv.Body):
        """A body with a name of its own."""

        grade: str = "S235"

    rounded = Steel.profile(x := np.linspace(-0.02, 0.02, 41), 2.0 * x**2, rigid=True)
    rounded.grade = "S355"
    with pytest.raises(AttributeError, match="Steel has no 'radiu'"):
        rounded.radiu = 0.25

    class Ball(mfv.Body):
        def __init__(self, diameter: float) -> None:
            super().__init__(shape="disk", radius=diameter / 2.0, rigid=True)

    assert Ball(diameter=0.5).keys() == DISK.keys()
    scene = cylinder(PRESS)
    scene.upper = rounded
    assert scene.run().outcome == "complete"
    scene.upper = Steel.disk(0.25, rigid=True)
    assert scene.upper.keys() == DISK.keys()


def test_lists_of_two_dimensions_are_refused() -> None:
    for keys, name in (
        ({"friction": mfv.Friction.coulomb(np.full((61, 1), 0.5))}, "friction%mu"),
        ({"friction": mfv.Friction.coulomb([[0.1, 0.2], [0.3, 0.4]])}, "friction%mu"),
        ({"history": mfv.History(tangential_force=[[0.0, 1.0e-4], [0.0, 0.0]])}, "history%tangential_force"),
    ):
        with pytest.raises(ValueError, match=f"{name} must have one dimension, not the shape"):
            cylinder(PRESS, **keys).contact()


def test_arrays_that_are_no_real_numbers_are_refused() -> None:
    masked = np.ma.masked_less(np.linspace(0.3, 0.7, 61), 0.4)
    with pytest.raises(TypeError, match="friction%mu: must be an array without masked values"):
        cylinder(PRESS, friction=mfv.Friction.coulomb(masked)).run()
    with pytest.raises(TypeError, match="friction%mu: must be real numbers, not complex"):
        cylinder(PRESS, friction=mfv.Friction.coulomb(np.full(61, 0.5 + 0.1j))).run()
    with pytest.raises(TypeError, match="height: must be real numbers"):
        mfv.Body.profile([0.0, 1.0], [0.0, 1j])


def test_numbers_of_numpy_are_numbers() -> None:
    scene = cylinder(mfv.Step(normal_force=np.float32(0.5), cycles=np.int64(2), friction=np.bool_(False)))
    assert "&step normal_force=0.5, friction=.false., cycles=2 /" in scene.text()


def test_a_step_in_which_nothing_is_named_is_not_lost() -> None:
    with pytest.raises(errors.InputError, match="&step 2: needs a target"):
        cylinder(PRESS, mfv.Step()).run()


def test_coefficients_one_a_node() -> None:
    coefficients = np.linspace(0.3, 0.7, 61)
    result = cylinder(PRESS, mfv.Step(tangential_force=1.0e-4), friction=mfv.Friction.coulomb(coefficients)).run(check=True)
    np.testing.assert_array_equal(result.mesh.static_friction, coefficients)


def test_coefficients_along_x_are_those_of_a_file(tmp_path: Path) -> None:
    x, static, kinetic = [-0.01, 0.0, 0.01], [0.5, 0.6, 0.7], [0.4, 0.5, 0.5]
    np.savetxt(tmp_path / "mu.txt", np.column_stack((x, static, kinetic)))
    steps = PRESS, mfv.Step(tangential_force=1.0e-4)
    from_file = mfv.Friction(law="static_kinetic", mu_file=tmp_path / "mu.txt")
    expected = cylinder(*steps, friction=from_file).run(check=True)
    result = cylinder(*steps, friction=mfv.Friction.static_kinetic(static, kinetic, x=x)).run(check=True)
    np.testing.assert_array_equal(result.mesh.kinetic_friction, expected.mesh.kinetic_friction)
    np.testing.assert_array_equal(result.state.shear, expected.state.shear)


def test_a_profile_in_memory_is_that_of_a_file(tmp_path: Path) -> None:
    x = np.linspace(-0.05, 0.05, 41)
    height = x**2 / 0.5
    np.savetxt(tmp_path / "bump.txt", np.column_stack((x, height)))
    from_file = mfv.Body(shape="profile", file=tmp_path / "bump.txt", rigid=True)
    expected, scene = (
        mfv.Scene(HALF_PLANE, body, mesh=MESH, steps=[mfv.Step(normal_force=1e-3)])
        for body in (from_file, mfv.Body.profile(x, height, rigid=True))
    )
    result = scene.run(check=True)
    np.testing.assert_array_equal(result.state.pressure, expected.run(check=True).state.pressure)
    height += 1.0  # the library and the result have their own
    again = mfv.stress.stress(pickle.loads(pickle.dumps(result)), 0.0, -0.005)
    assert again["sigma_yy"] == mfv.stress.stress(expected.run(), 0.0, -0.005)["sigma_yy"] < 0.0


def test_a_file_tells_that_its_arrays_were_in_memory(tmp_path: Path) -> None:
    x = np.linspace(-0.02, 0.02, 81)
    rounded = mfv.Body.profile(x, 2.0 * x**2, rigid=True)
    scene = cylinder(PRESS, mfv.Step(tangential_force=1e-4), output=mfv.Output(states="none"))
    scene.upper = rounded
    ran = scene.run(output=tmp_path / "x.h5")
    again, note = mfv.load_history.with_states_between(ran, 8)
    assert (len(again.steps), note) == (8, "") and scene.output == mfv.Output(states="none")
    read = mfv.read(tmp_path / "x.h5")
    assert np.nanmax(mfv.stress.grid(ran, across=5, down=5)["von_mises"]) > 0.0
    with pytest.raises(ValueError, match=r"arrays of the scene \(upper body\) were given in memory and are not in the file"):
        mfv.stress.grid(read)
    again, note = mfv.load_history.with_states_between(read, 8)
    assert len(again.steps) == 1 and "given in memory" in note


def test_a_matrix_in_memory_is_that_of_a_file(tmp_path: Path) -> None:
    x = (np.arange(21) - 10) * 8.0e-4
    distance = np.abs(x[:, None] - x[None, :])
    compliance = np.log(0.25 / np.maximum(distance, 2.0e-4)) * 0.5
    with h5py.File(tmp_path / "body.h5", "w") as file:
        file["x"], file["compliance"] = x, compliance
    step = mfv.Step(normal_force=1.0e-4)
    expected = mfv.Scene(mfv.Body(shape="matrix", file=tmp_path / "body.h5"), DISK, steps=[step]).run(check=True)
    result = mfv.Scene(mfv.Body.matrix(x, compliance=compliance), DISK, steps=[step]).run(check=True)
    np.testing.assert_array_equal(result.state.pressure, expected.state.pressure)
    stiff = mfv.Scene(mfv.Body.matrix(x, stiffness=np.linalg.inv(compliance)), DISK, steps=[step]).run(check=True)
    np.testing.assert_allclose(stiff.state.pressure, expected.state.pressure, rtol=1e-6, atol=1e-9)
    with pytest.raises(errors.InputError, match=r"lower body.*compliance has the shape 21 x 20"):
        mfv.Scene(mfv.Body.matrix(x, compliance=compliance[:, :20]), DISK, steps=[step]).run()
    transposed = np.asfortranarray(compliance + np.triu(np.ones_like(compliance)))
    with pytest.raises(errors.InputError, match="compliance is not symmetric"):
        mfv.Scene(mfv.Body.matrix(x, compliance=transposed), DISK, steps=[step]).run()


def test_a_result_without_a_directory_is_refused_before_solving(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mfv.Case, "run", lambda *_, **__: pytest.fail("was solved"))
    with pytest.raises(errors.FileError, match="x.h5: cannot be written: .*nowhere does not exist or is not a directory"):
        cylinder(PRESS).run(output=tmp_path / "nowhere" / "x.h5")


def test_scenes_are_values() -> None:
    scene = cylinder(PRESS, friction=mfv.Friction.coulomb([0.3, 0.4], x=[-1.0, 1.0]))
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert other == scene and other.friction is not scene.friction
        other.friction.data["mu"][0] = 0.5
        assert other != scene
    assert cylinder(PRESS) != cylinder()
    assert MESH != PRESS and PRESS != "press" and scene != "scene"
    with pytest.raises(TypeError):
        hash(scene)


def test_scenes_show_what_they_have() -> None:
    scene = cylinder(PRESS, title="<b>")
    assert repr(scene.upper) == "Body(shape='disk', rigid=True, radius=0.25)"
    assert repr(scene).startswith("Scene(lower=Body(shape='half_plane'")
    assert repr(mfv.Body.profile([0.0, 1.0], [0.0, 1.0])).endswith("data={'x': array(2), 'height': array(2)})")
    shown = scene._repr_html_()
    for word in ("&lt;b&gt;", "half_plane", "radius", "friction", "normal_force", "goodman"):
        assert word in shown
    assert "<b>" not in shown and "<script" not in shown
