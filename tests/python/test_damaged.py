"""Damaged results and texts: a message, never a traceback."""

import contextlib
import io
import os
import random
import shutil

import h5py
import numpy as np
import pytest

import mfv
from mfv import joint
from mfv.commands import main

CASE = """&scene title='damaged' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, shear_modulus=1.0, poisson_ratio=0.2 /
&friction law='coulomb', mu=0.7 /
&mesh nodes=21 /
&step normal_force=1e-3, friction=.false. /
&step tangential_force=2e-4, cycles=2 /
&output error_estimate=.true. /
"""

DAMAGES = {
    "text": lambda values: "many",
    "texts": lambda values: np.array(["many", "more"], dtype="S"),
    "missing": lambda values: None,
    "number": lambda values: 1.0,
    "matrix": lambda values: np.ones((3, 2)),
    "shorter": lambda values: np.atleast_1d(values)[:-1],
    "complex": lambda values: np.asarray(values) * 1j,
    "nan": lambda values: np.asarray(values) * np.nan,
    "flags": lambda values: np.asarray(values) > 0,
}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("damaged") / "whole.h5"
    with mfv.Case.from_text(CASE) as case:
        assert case.run() == "complete"
        case.write(path)
    return path


def damage(whole, path, name, how):
    """A copy of a result with one damaged dataset."""
    shutil.copy(whole, path)
    with h5py.File(path, "a") as file:
        values = file[name][()]
        del file[name]
        changed = DAMAGES[how](values)
        if changed is not None:
            file[name] = changed


def answer(arguments):
    """Exit code and messages of a command."""
    errors = io.StringIO()
    with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
        code = main([os.fspath(argument) for argument in arguments])
    return code, errors.getvalue()


def names_of(path):
    names = []
    with h5py.File(path) as file:
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    return sorted(names)


@pytest.mark.parametrize("seed", range(2))
def test_commands_on_damaged_results(seed, whole, tmp_path):
    """Random datasets, each damage: an exit code and a message that names the file."""
    chosen = random.Random(seed)
    names = names_of(whole)
    for number, how in enumerate(DAMAGES):
        for name in chosen.sample(names, 2):
            path = tmp_path / f"damaged{number}.h5"
            damage(whole, path, name, how)
            for command in [["info", path], *([["compare", path, whole]] if chosen.random() < 0.2 else [])]:
                code, errors = answer(command)
                assert "Traceback" not in errors and code in (0, 2), (name, how, errors)
                assert (code == 0) == (errors == "") or code == 0, (name, how, errors)
                if code:
                    assert errors.startswith("mfv: ") and path.name in errors and len(errors) < 3000, (name, how, errors)


@pytest.mark.parametrize(
    "name, how",
    [
        ("mesh/x", "missing"),
        ("state/pressure", "number"),
        ("summary/normal_force", "missing"),
        ("history/shift", "missing"),
        ("history/shift", "shorter"),
        ("steps/0001/shear", "matrix"),
        ("steps/0002/contact_edge", "missing"),
        ("mesh/width", "missing"),
    ],
)
def test_plots_and_reports_of_damaged_results(name, how, whole, tmp_path):
    path = tmp_path / "damaged.h5"
    damage(whole, path, name, how)
    for command in (["plot", path, "-o", tmp_path / "one.png"], ["report", path, "-o", tmp_path / "one.html"]):
        code, errors = answer(command)
        assert "Traceback" not in errors and code in (0, 2), (name, how, errors)


@pytest.mark.parametrize("part", [0, 0.01, 0.3, 0.7, 0.99])
def test_truncated_results(part, whole, tmp_path):
    path = tmp_path / "short.h5"
    content = whole.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    code, errors = answer(["info", path])
    assert code == 2 and errors.startswith("mfv: ") and "short.h5" in errors and "Traceback" not in errors


@pytest.mark.parametrize(
    "text",
    ["[" * 12000, '{"a":' * 12000, "[" * 12000 + "]" * 12000, "", "nan", '{"format": NaN}', "[1, 2", '"\\ud800"', "1" * 6000],
)
def test_texts_that_are_no_joint(text):
    with pytest.raises(ValueError, match="not the JSON text of a joint"):
        joint.from_json(text)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e400", "1" + "0" * 400, "true", '"1"', "null", "[1]"])
def test_joints_have_finite_numbers(number):
    text = joint.BoucWen(stiffness=2.0, sliding_force=1.0, shape=0.5, exponent=1.0, elastic=0.25).to_json()
    assert "0.25" in text
    with pytest.raises(ValueError, match="must be a number"):
        joint.from_json(text.replace("0.25", number))
