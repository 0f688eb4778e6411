"""The example of a finite-element body: its matrix, and its contact against that of the half-plane."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import h5py
import numpy as np
import pytest

pytest.importorskip("skfem")

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "finite_element_body.py"


def loaded(path: Path) -> ModuleType:
    """The module in a file."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


example = loaded(EXAMPLE)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """Where body.h5 of `comparison` is."""
    return tmp_path_factory.mktemp("finite_element_body")


@pytest.fixture(scope="module")
def comparison(kept):
    """The example with its 41 nodes."""
    return example.compare(41, kept)


@pytest.fixture(scope="module")
def compliance(comparison, kept):
    """The matrix in body.h5, as blocks of the directions of displacement and force, each of the shape (41, 41)."""
    with h5py.File(kept / "body.h5") as file:
        return file["compliance"][()].reshape(2, 41, 2, 41).transpose(0, 2, 1, 3)


def difference(comparison, name: str) -> float:
    """Relative l2 difference of the tractions of the sheared body from those of the half-plane."""
    numbers, expected = (result.state[name] for result in comparison)
    return float(np.linalg.norm(numbers - expected) / np.linalg.norm(expected))


def test_nodes_are_at_the_same_places(comparison):
    """Both meshes are compared node by node below."""
    numbers, expected = comparison
    assert numbers.outcome == expected.outcome == "complete"
    assert numbers.mesh.x == pytest.approx(expected.mesh.x, abs=1e-15)


def test_matrix_is_symmetric(compliance):
    """Nothing makes it symmetric afterwards. Measured: 3e-14 of the largest entry (15 to 121 nodes: 1e-15 to 3e-13)."""
    assert compliance == pytest.approx(compliance.transpose(1, 0, 3, 2), abs=1e-11 * np.abs(compliance).max())


def test_normal_force_pulls_the_surface_towards_itself(compliance):
    """By (1 - 2 nu)/(4 G) = 0.1 everywhere, on a half-plane. Measured five elements away and more: 0.0981 to 0.0998."""
    normal, tangential = 0, 1
    moved = compliance[tangential, normal]
    beside = np.subtract.outer(np.arange(41), np.arange(41))
    assert moved[beside >= 5] == pytest.approx(-0.1, rel=0.03)
    assert moved[beside <= -5] == pytest.approx(0.1, rel=0.03)


def test_peak_pressure(comparison):
    """Measured: -1.0e-4 with 41 nodes; at most 1.0e-4 with 37 to 85, 6e-4 with 19 to 25."""
    assert example.differences(comparison)["peak pressure"] == pytest.approx(0.0, abs=5e-4)


def test_contact_half_width(comparison):
    """Measured: the same nodes in contact with 41; of 16 meshes of 19 to 85 nodes two have one node more."""
    one_node = example.half_width_step(comparison)
    assert one_node < 0.03
    assert abs(example.differences(comparison)["contact half-width"]) < 1.01 * one_node


def test_shift(comparison):
    """Measured, with the datum that stands for the clamped bottom: 4e-5; at most 2.5e-4 with 19 to 85 nodes."""
    assert example.differences(comparison)["shift"] == pytest.approx(0.0, abs=5e-4)


def test_tractions(comparison):
    """Measured: pressure 0.7 %, shear 1.7 %, most of it at the edges of contact and stick."""
    assert difference(comparison, "pressure") < 0.015
    assert difference(comparison, "shear") < 0.035


def test_finer_surface_is_better(tmp_path):
    """Means over four meshes, since single ones vary with the place of the edges in their elements by a factor of 1.5.

    Measured: pressure 1.09 % to 0.43 %, shear 2.7 % to 1.1 %, to 0.40 of the coarse meshes; first order would be 0.35.
    """
    coarse, fine = (
        np.mean([[difference(pair, name) for name in ("pressure", "shear")] for pair in pairs], axis=0)
        for pairs in (
            [example.compare(nodes, tmp_path) for nodes in (19, 21, 23, 25)],
            [example.compare(nodes, tmp_path) for nodes in (57, 61, 65, 69)],
        )
    )
    assert (fine < 0.55 * coarse).all()


def test_program(tmp_path, monkeypatch, capsys):
    """Table, picture and saved files."""
    picture, kept = tmp_path / "picture.png", tmp_path / "kept"
    arguments = [EXAMPLE.name, "--surface-nodes", "21", "-o", str(picture), "--keep", str(kept)]
    monkeypatch.setattr("sys.argv", arguments)
    example.main()
    table = capsys.readouterr().out
    assert all(name in table for name in example.QUANTITIES)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in kept.iterdir()) == ["body.h5", "finite_element_body.nml"]


def test_too_few_nodes(monkeypatch, capsys):
    """Told in words, not by a traceback."""
    monkeypatch.setattr("sys.argv", [EXAMPLE.name, "--surface-nodes", "3"])
    with pytest.raises(SystemExit):
        example.main()
    assert "15 or more" in capsys.readouterr().err
