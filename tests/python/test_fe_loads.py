"""Loads from finite-element results: closed forms on coarse meshes, conventions, formats (invented, and a pad of CalculiX), errors."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import PROJECT

import mfv
from mfv.commands import main
from mfv.finite_elements import ContactLoads, from_fe
from mfv.finite_elements.readers import read_surface

Array = NDArray[np.float64]
RESULTS = PROJECT / "tests/finite_elements/results"

#: Hertz and a stuck contact with a = p0 = 1: p = sqrt(1 - x^2), q = Q/(pi sqrt(1 - x^2)).
P, Q = 0.5 * np.pi, 0.3
K_N, K_T = np.sqrt(2.0), Q / (np.pi * np.sqrt(2.0))


def nodes_of(spacing: float, offset: float = 0.0) -> Array:
    """Nodes at equal distances on both sides of the contact; `offset` moves them by a part of the spacing."""
    return spacing * (np.arange(-np.ceil(2.5 / spacing), np.ceil(2.5 / spacing) + 1) + offset)


def forces_of(x: Array, traction: Callable[[Array], Array], is_quadratic: bool = False) -> Array:
    """Consistent nodal forces of a traction between -1 and 1; `traction` has the angle, x = sin(angle), and is multiplied by dx/d angle."""
    points, weights = np.polynomial.legendre.leggauss(40)
    forces = np.zeros(len(x))
    for start in range(0, len(x) - 1, 1 + is_quadratic):
        nodes = np.arange(start, start + 2 + is_quadratic)
        ends = np.arcsin(np.clip(x[nodes[[0, -1]]], -1.0, 1.0))
        angle = ends.mean() + 0.5 * np.ptp(ends) * points
        for node in nodes:
            shape = np.prod([(np.sin(angle) - x[k]) / (x[node] - x[k]) for k in nodes if k != node], axis=0)
            forces[node] += 0.5 * np.ptp(ends) * np.sum(weights * shape * traction(angle))
    return forces


def hertz(angle: Array) -> Array:
    return np.cos(angle) ** 2


def stuck(angle: Array) -> Array:
    return np.full_like(angle, Q / np.pi)


def arrays(spacing: float = 0.25, offset: float = 0.3, share: float = 1.0, **others: Any) -> dict[str, Any]:
    """Nodal forces on the lower body at one time."""
    x = nodes_of(spacing, offset)
    return {"x": x, "force_x": share * forces_of(x, stuck), "force_y": -share * forces_of(x, hertz), **others}


def same(first: ContactLoads, second: ContactLoads, tolerance: float = 1e-9) -> None:
    for name in ("t", "P", "Q", "M", "centre"):
        np.testing.assert_allclose(getattr(first, name), getattr(second, name), rtol=tolerance, atol=tolerance, err_msg=name)
    for one, other in ((first.left, second.left), (first.right, second.right)):
        for name in ("x", "K_N", "K_T"):
            np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-5, atol=1e-6, err_msg=name)


# --- closed forms ---


@pytest.mark.parametrize("spacing", [0.4, 0.25, 0.125, 0.0625])
@pytest.mark.parametrize("offset", [0.0, 0.17, 0.5, 0.83])
def test_closed_forms_from_nodal_forces(spacing: float, offset: float) -> None:
    loads = from_fe(arrays(spacing, offset))
    np.testing.assert_allclose([loads.P[0], loads.Q[0]], [P, Q], rtol=1e-12)
    assert abs(loads.centre) < 3e-2 * spacing and abs(loads.M[0] - P * loads.centre) < 1e-12
    for edge, side in ((loads.left, -1.0), (loads.right, 1.0)):
        assert abs(edge.x[0] + loads.centre - side) < edge.x_error[0]
        assert abs(edge.K_N[0] - K_N) < edge.K_N_error[0]
        assert abs(edge.K_T[0] - K_T) < edge.K_T_error[0]


def errors_at(spacing: float, source: Callable[[float, float], dict[str, Any]]) -> Array:
    """The largest errors of edge, K_N and K_T over positions of the mesh."""
    loads = [from_fe(source(spacing, offset), centre=0.0).right for offset in (0.0, 0.17, 0.33, 0.5, 0.67, 0.83)]
    return np.array(
        [max(abs(each.x[0] - 1.0) for each in loads), max(abs(each.K_N[0] / K_N - 1.0) for each in loads)]
        + [max(abs(each.K_T[0] / K_T - 1.0) for each in loads)]
    )


def sampled(spacing: float, offset: float) -> dict[str, Any]:
    x = nodes_of(spacing, offset)
    inside = np.maximum(1.0 - x**2, 0.0)
    shear = np.where(inside > 1e-9, Q / np.pi / np.sqrt(np.maximum(inside, 1e-9)), 0.0)
    return {"x": x, "pressure": np.sqrt(inside), "shear": shear}


@pytest.mark.parametrize("source", [arrays, sampled])
def test_order_of_convergence(source: Callable[[float, float], dict[str, Any]]) -> None:
    """Edges of third order, K_N and K_T of second order, from forces and from tractions at nodes."""
    coarse, fine = errors_at(0.125, source), errors_at(0.03125, source)
    assert np.all(np.log2(coarse / fine) / 2.0 > [2.7, 1.8, 1.8])
    assert np.all(fine < [5e-5, 1e-3, 1e-3])


def test_tractions_at_nodes_have_errors() -> None:
    for spacing in (0.25, 0.125):
        for offset in (0.0, 0.33, 0.7):
            loads = from_fe(sampled(spacing, offset), centre=0.0)
            assert "P where it is largest is known to about" in loads.notes[0]
            for edge in (loads.left, loads.right):
                assert abs(abs(edge.x[0]) - 1.0) < edge.x_error[0]
                assert abs(edge.K_N[0] - K_N) < edge.K_N_error[0] and abs(edge.K_T[0] - K_T) < edge.K_T_error[0]


def test_quadratic_elements() -> None:
    """Of a surface without a mesh every second node is between corners; resultants are exact, edges those of the corners' mesh."""
    x = nodes_of(0.125)
    quadratic = {"x": x, "force_x": forces_of(x, stuck, True), "force_y": -forces_of(x, hertz, True)}
    same(from_fe(quadratic, quadratic=True), from_fe(arrays(0.25, 0.0)))
    with pytest.raises(ValueError, match="an odd number of nodes along a surface, not 40"):
        from_fe({name: values[1:] for name, values in quadratic.items()}, quadratic=True)


def test_quadratic_elements_of_a_deck(tmp_path: Path) -> None:
    """Sides of elements with eight nodes, with corners and nodes between them in any order of numbers."""
    x = nodes_of(0.125)
    size, half = len(x), len(x) // 2
    top = {at: at + 1 for at in range(size)}
    bottom = {at: size + at + 1 for at in range(size)}
    sides = {at: 2 * size + at + 1 for at in range(0, size, 2)}
    lines = [
        "*NODE",
        *(f"{n}, {x[at]:.17g}, 0." for at, n in top.items()),
        *(f"{n}, {x[at]:.17g}, -2." for at, n in bottom.items()),
    ]
    lines += [*(f"{n}, {x[at]:.17g}, -1." for at, n in sides.items()), "*ELEMENT, TYPE=CPE8R, ELSET=BODY"]
    for e, at in enumerate(range(0, size - 1, 2), start=1):
        corners = [bottom[at], bottom[at + 2], top[at + 2], top[at]]
        lines.append(", ".join(map(str, [e, *corners, bottom[at + 1], sides[at + 2], top[at + 1], sides[at]])))
    lines += ["*SURFACE, NAME=TOPS", "BODY, S3"]
    (tmp_path / "job.inp").write_text("\n".join(lines) + "\n")
    across, along = forces_of(x, stuck, True), -forces_of(x, hertz, True)
    rows = [f"{top[at]},{across[at]:.17g},{along[at]:.17g}" for at in range(size)]
    (tmp_path / "job.csv").write_text("node,force_x,force_y\n" + "\n".join(rows[half:] + rows[:half]) + "\n")
    given = {"x": x, "force_x": across, "force_y": along}
    same(from_fe(tmp_path / "job.csv", "TOPS", mesh=tmp_path / "job.inp"), from_fe(given, quadratic=True))
    assert len(read_surface(tmp_path / "job.csv", "TOPS", tmp_path / "job.inp").faces) == half


def test_what_cannot_be_told_is_not() -> None:
    """A punch with corners, a node set that ends in the contact, too few nodes."""
    x = np.linspace(-1.0, 1.0, 41)
    punch = from_fe({"x": x, "pressure": 1.0 / np.sqrt(1.02 - x**2)})
    assert np.isnan(punch.right.K_N[0]) and punch.right.x[0] == 1.0 and "reaches the end of the node set" in punch.notes[1]
    x = np.linspace(-1.5, 1.5, 61)
    beyond = from_fe({"x": x, "pressure": np.where(np.abs(x) < 1.0, 1.0 / np.sqrt(1.02 - np.minimum(x**2, 1.0)), 0.0)})
    assert np.isnan(beyond.left.K_N[0])
    few = from_fe(arrays(0.9))
    assert np.isnan(few.right.K_N[0]) and np.isfinite(few.P[0]) and "K_N and K_T" in few.notes[0]


def test_times_without_contact() -> None:
    steps = {name: np.array([0.0 * values, values, 2.0 * values]) for name, values in arrays().items() if name != "x"}
    loads = from_fe({"x": arrays()["x"], "t": [0.0, 1.0, 2.0], **steps})
    np.testing.assert_allclose(loads.P, [0.0, P, 2.0 * P])
    assert np.isnan(loads.right.x[0]) and np.isfinite(loads.right.x[1:]).all()
    assert loads.table()["time"].tolist() == [1.0, 2.0] and len(loads.steps()) == 2


# --- conventions ---


def test_mirror_image() -> None:
    given, image = arrays(), arrays()
    image |= {"x": -given["x"][::-1], "force_x": -given["force_x"][::-1], "force_y": given["force_y"][::-1]}
    loads, mirrored = from_fe(given), from_fe(image)
    np.testing.assert_allclose([mirrored.P, mirrored.Q, mirrored.M], [loads.P, -loads.Q, -loads.M], atol=1e-14)
    np.testing.assert_allclose(mirrored.left.K_N, loads.right.K_N, rtol=1e-9)
    np.testing.assert_allclose(mirrored.left.K_T, -loads.right.K_T, rtol=1e-9)


def test_forces_on_the_upper_body_are_opposite() -> None:
    given, opposite = arrays(), arrays()
    opposite |= {"force_x": -given["force_x"], "force_y": -given["force_y"]}
    same(from_fe(given), from_fe(opposite))
    same(from_fe(given), from_fe(given, body="upper", sign=-1.0))
    with pytest.raises(ValueError, match="pull at the lower body; with sign=-1"):
        from_fe(opposite, body="lower")
    same(from_fe(sampled(0.25, 0.3)), from_fe(sampled(0.25, 0.3) | {"shear": -sampled(0.25, 0.3)["shear"]}, shear_sign=-1.0))


@pytest.mark.parametrize("angle", [30.0, 90.0, 180.0, -110.0])
def test_turned_model(angle: float) -> None:
    """The model turned by an angle; stresses turn, too."""
    x = nodes_of(0.25, 0.3)
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    flat = arrays(stress_xx=np.full(len(x), 5.0), stress_yy=np.full(len(x), -1.0), stress_xy=np.full(len(x), 2.0))
    turned = flat | {
        "x": cosine * x,
        "y": sine * x,
        "force_x": cosine * flat["force_x"] - sine * flat["force_y"],
        "force_y": sine * flat["force_x"] + cosine * flat["force_y"],
        "stress_xx": cosine**2 * flat["stress_xx"] + sine**2 * flat["stress_yy"] - 2.0 * sine * cosine * flat["stress_xy"],
        "stress_yy": sine**2 * flat["stress_xx"] + cosine**2 * flat["stress_yy"] + 2.0 * sine * cosine * flat["stress_xy"],
        "stress_xy": sine * cosine * (flat["stress_xx"] - flat["stress_yy"]) + (cosine**2 - sine**2) * flat["stress_xy"],
    }
    loads, other = from_fe(flat), from_fe(turned, angle=angle)
    same(loads, other)
    assert loads.lower_bulk is not None and other.lower_bulk is not None
    np.testing.assert_allclose(other.lower_bulk.stress, loads.lower_bulk.stress)
    if angle == 90.0:
        with pytest.raises(ValueError, match=r"at the same place along the contact; is angle=0 the direction"):
            from_fe(turned)


def test_thickness_and_units() -> None:
    """Forces of a model 2.5 thick; one in metres and kilonewtons for a scene in millimetres and newtons."""
    same(from_fe(arrays()), from_fe(arrays(share=2.5), thickness=2.5))
    metres = arrays(share=1e-3)
    metres["x"] = 1e-3 * metres["x"]
    loads = from_fe(metres, length_scale=1e3, force_scale=1e3, thickness=1e-3)
    same(from_fe(arrays()), loads)


def test_moment_about_another_point() -> None:
    loads = from_fe(arrays(offset=0.0), centre=0.2)
    np.testing.assert_allclose(loads.M, 0.2 * P, rtol=1e-12)
    assert loads.right.x[0] == pytest.approx(0.8, abs=5e-3)


def test_the_moment_is_that_of_a_scene() -> None:
    punch = mfv.Scene(
        mfv.Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.3),
        mfv.Body.flat_punch(1.0),
        mesh=mfv.Mesh(nodes=101, half_width=1.0),
        steps=[mfv.Step(normal_force=1e-3, moment=2e-4)],
    ).run(check=True)
    x, pressure = np.array(punch.mesh.x), np.array(punch.state.pressure)
    loads = from_fe({"x": x, "force_x": 0.0 * x, "force_y": -pressure * (x[1] - x[0])}, centre=0.0)
    np.testing.assert_allclose([loads.P[0], loads.M[0]], [1e-3, 2e-4], rtol=1e-9)


# --- bulk stress ---


def test_bulk_stress_beside_a_sheared_contact() -> None:
    """The stress of a stuck half-plane is sigma - (2/pi) int q/(x - s) ds = sigma - 2 Q/(pi sqrt(x^2 - 1)) beside the contact; of the upper
    body with the other sign."""
    x = nodes_of(0.125, 0.3)
    beside = np.sign(x) * 2.0 * Q / np.pi / np.sqrt(np.maximum(x**2 - 1.0, 1e-3))
    for body, sign in (("lower", 1.0), ("upper", -1.0)):
        stresses = {"stress_xx": 7.0 - sign * beside, "stress_yy": 0.0 * x, "stress_xy": 0.0 * x}
        given = arrays(0.125, 0.3, **stresses)
        if body == "upper":
            given |= {"force_x": -given["force_x"], "force_y": -given["force_y"]}
        loads = from_fe(given)
        bulk, none = (loads.lower_bulk, loads.upper_bulk)[:: int(sign)]
        assert bulk is not None and none is None
        assert abs(bulk.stress[0] - 7.0) < 2e-3 and bulk.error[0] < 5e-3
        column = f"{body}_bulk_stress"
        assert column in loads.table() and f"{column}_error" in loads.edges()
    narrow = from_fe(given, bulk_range=(20.0, 30.0))
    assert narrow.upper_bulk is None and "no bulk stress of the upper body" in narrow.notes[0]


def test_the_error_of_the_bulk_stress_is_what_remains() -> None:
    x = nodes_of(0.25, 0.3)
    rng = np.random.default_rng(1)
    stress = 7.0 + rng.normal(0.0, 0.5, len(x))
    loads = from_fe(arrays(share=1.0, stress_xx=stress, stress_yy=0.0 * x, stress_xy=0.0 * x), bulk_range=(0.1, 3.0))
    assert loads.lower_bulk is not None and 0.2 < loads.lower_bulk.error[0] < 1.2


# --- round trip ---


def scene(**keys: Any) -> mfv.Scene:
    bodies = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.disk(1.0, rigid=True)
    return mfv.Scene(*bodies, mesh=mfv.Mesh(nodes=201), friction=mfv.Friction.coulomb(0.5), coupling="none", **keys)


def test_round_trip_through_history(tmp_path: Path) -> None:
    """A cylinder pressed and sheared: nodal forces of its tractions give back the loads; the table gives the same state."""
    steps = [mfv.Step(normal_force=1e-3), mfv.Step(tangential_force=2e-4, lower_bulk_stress=1e-3), mfv.Step(tangential_force=-2e-4)]
    first = scene(steps=steps, output=mfv.Output(states="steps")).run(check=True)
    x = np.array(first.mesh.x)
    width = x[1] - x[0]
    around = width * np.arange(-100, 101) + x[len(x) // 2]
    there = np.searchsorted(around, x - 0.5 * width)
    given: dict[str, Any] = {"x": around, "t": [1.0, 2.0, 3.0]}
    for name, field, sign in (("force_x", "shear", 1.0), ("force_y", "pressure", -1.0)):
        given[name] = np.zeros((3, len(around)))
        given[name][:, there] = [sign * width * np.array(state[field]) for state in first.steps]
    loads = from_fe(given, centre=0.0)
    np.testing.assert_allclose(loads.P, 1e-3, rtol=1e-9)
    np.testing.assert_allclose(loads.Q, [0.0, 2e-4, -2e-4], rtol=1e-9, atol=1e-14)
    loads.write(tmp_path / "loads.txt")
    second = scene(history=mfv.History(file=tmp_path / "loads.txt")).run(check=True)
    third = scene(steps=loads.steps()).run(check=True)
    fourth = scene(history=loads.history()).run(check=True)
    for other in (third, fourth):
        np.testing.assert_allclose(other.state.shear, second.state.shear, rtol=0.0, atol=1e-7 * np.max(second.state.pressure))
    np.testing.assert_allclose(second.summary.tangential_force, -2e-4, rtol=1e-9)


def test_an_edge_by_itself() -> None:
    """`Body.edge` under K_N(t) and K_T(t) of the model: with its own half-width as edge_length the loads of the model."""
    loads = from_fe(arrays(0.03125, 0.4))
    modulus = 4.0 * P / np.pi  # of any size: K_N and edge_length determine P
    upper = mfv.Body.edge(float(loads.right.K_N[0]), 1.0, rigid=True)
    lower = mfv.Body.half_plane(youngs_modulus=modulus, poisson_ratio=0.0)
    edge = mfv.Scene(lower, upper, coupling="none", friction=mfv.Friction.coulomb(0.9), steps=loads.steps(edge="right")).run(
        check=True
    )
    np.testing.assert_allclose([edge.summary.normal_force, edge.summary.tangential_force], [P, Q], rtol=2e-3)
    mirrored = loads.table(edge="left")
    np.testing.assert_allclose(mirrored["shear_intensity"], -loads.left.K_T)
    with pytest.raises(ValueError, match="edge: must be 'left' or 'right', not 'top'"):
        loads.history(edge="top")
    with pytest.raises(ValueError, match="K_N or K_T of the left edge is unknown at time 0"):
        from_fe(arrays(0.9)).table(edge="left")


# --- formats ---


def frames() -> tuple[Array, list[float], Array, Array]:
    """x, times and nodal forces (times, nodes) of three times."""
    given = arrays()
    share = np.array([[0.5], [1.0], [0.8]])
    return given["x"], [1.0, 2.0, 3.0], share * given["force_x"], share * given["force_y"]


def expected() -> ContactLoads:
    x, times, across, along = frames()
    return from_fe({"x": x, "t": times, "force_x": across, "force_y": along})


def rows_of(text: Callable[[float, int, float, float, float], str]) -> str:
    x, times, across, along = frames()
    rows = [(t, i + 1, float(x[i]), float(across[n, i]), float(along[n, i])) for n, t in enumerate(times) for i in range(len(x))]
    return "\n".join(text(*row) for row in rows) + "\n"


def deck(path: Path, depth: float = 1.0) -> Path:
    """An input deck of a row of plane elements below the surface, and one of them far away; the set TOP, the surface TOPS."""
    x = frames()[0]
    size = len(x)
    nodes = [f"{i + 1}, {x[i]:.12g}, 0." for i in range(size)] + [f"{size + i + 1}, {x[i]:.12g}, {-depth}" for i in range(size)]
    elements = [f"{i}, {i}, {size + i}, {size + i + 1}, {i + 1}" for i in range(1, size)]
    lines = ["*Heading", "** a comment", "*Node", *nodes, "*Element, type=CPE4, elset=BODY", *elements]
    lines += ["*Nset, nset=TOP, generate", f"1, {size}, 1", "*Surface, type=ELEMENT, name=TOPS", "BODY, S4"]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_csv(tmp_path: Path) -> None:
    path = tmp_path / "nodes.csv"
    path.write_text("time,node,x [mm],force_x,force_y\n" + rows_of(lambda t, i, x, fx, fy: f"{t},{i},{x!r},{fx!r},{fy!r}"))
    same(from_fe(path), expected())
    assert from_fe(path).source == str(path)
    german = "time;x;Kraft 1;Kraft 2\n" + rows_of(lambda t, i, x, fx, fy: f"{t};{x!r};{fx!r};{fy!r}".replace(".", ","))
    path.write_text(german)
    same(from_fe(path, columns={"force_x": "Kraft 1", "force_y": "Kraft 2"}), expected())


def test_csv_of_an_odb(tmp_path: Path) -> None:
    """Names of Abaqus, frames with times in steps, two instances, normal and frictional forces apart."""
    head = "ODB Name,Step,Frame,Part Instance Name,Node Label,X,Y,CNORMF-CNORMF1,CNORMF-CNORMF2,CSHEARF-CSHEARF1,CSHEARF-CSHEARF2\n"

    def row(t: float, i: int, x: float, fx: float, fy: float) -> str:
        step, time = ("Press", t) if t < 1.5 else ("Shear", t - 1.0)
        frame = f"Increment     1: Step Time =    {time:.4g}"
        return f"job.odb,{step},{frame},PAD-1,{i},{x!r},0,0,{fy!r},{fx!r},0\njob.odb,{step},{frame},BASE-1,{i},{x!r},9,0,{-fy!r},{-fx!r},0"

    path = tmp_path / "odb.csv"
    path.write_text(head + rows_of(row))
    same(from_fe(path, "PAD-1"), expected())
    with pytest.raises(ValueError, match=r"no rows of 'PAD' in the column Part Instance Name; there are PAD-1, BASE-1"):
        from_fe(path, "PAD")
    with pytest.raises(ValueError, match=r"give the surface; the column Part Instance Name has PAD-1, BASE-1"):
        from_fe(path)


def report(times: list[float], names: str, row: Callable[[int, int], str], size: int) -> str:
    text = ""
    for n, time in enumerate(times):
        text += (
            "*" * 80 + "\nField Output Report, written Mon Jan  5 12:00:00 2026\n\nSource 1\n---------\n\n   ODB: C:/temp/job.odb\n"
        )
        text += f"   Step: Step-{n + 1}\n   Frame: Increment     10: Step Time =    {time:.4f}\n\nLoc 1 : Nodal values from source 1\n\n"
        text += 'Output sorted by column "Node Label".\n\nField Output reported at nodes for part: PAD-1\n\n'
        count = len(names.split("  "))
        text += f"            Node  {names}\n           Label" + "          @Loc 1" * count + "\n" + "-" * 65 + "\n"
        text += "\n".join(row(n, i) for i in range(size))
        text += "\n\n\n  Minimum        -1.  0.\n      At Node           1     1\n\n  Total   -3.   0.\n\n"
    return text


def test_report_of_abaqus(tmp_path: Path) -> None:
    x, times, across, along = frames()
    path = tmp_path / "job.rpt"
    path.write_text(
        report(
            [1.0] * 3,
            "CSHEARF.CSHEARF1 PAD/BASE  CNORMF.CNORMF2 PAD/BASE",
            lambda n, i: f"{i + 1}  {across[n, i]:.17g}  {along[n, i]:.17g}",
            len(x),
        )
    )
    columns = {"force_x": "CSHEARF.CSHEARF1", "force_y": "CNORMF.CNORMF2"}
    loads = from_fe(path, "TOP", mesh=deck(tmp_path / "job.inp"), columns=columns)
    same(loads, expected())
    assert loads.t.tolist() == times
    with pytest.raises(ValueError, match="has no column x"):
        from_fe(path, "TOP", columns=columns)
    path.write_text(
        report(
            [1.0] * 3,
            "COORD.COOR1  CSHEARF.CSHEARF1  CNORMF.CNORMF2",
            lambda n, i: f"{i + 1}  {x[i]:.17g}  {across[n, i]:.17g}  {along[n, i]:.17g}",
            len(x),
        )
    )
    same(from_fe(path, columns=columns), expected())


def test_report_of_several_regions(tmp_path: Path) -> None:
    """Every region has a table in each frame, with the nodes that it shares with others; the same numbers in two parts are refused."""
    x, _, across, along = frames()

    def table(region: int, nodes: range, factor: float) -> str:
        names, half = "COORD.COOR1  CSHEARF.CSHEARF1  CNORMF.CNORMF2", ""
        for n in range(3):
            one = report(
                [1.0], names, lambda _, i, n=n: f"{i + 1}  {x[i]:.17g}  {across[n, i] * factor:.17g}  {along[n, i]:.17g}", len(x)
            )
            lines = one.splitlines()
            rows = [line for line in lines if line.split()[:1] in [[f"{i + 1}"] for i in range(len(x)) if i not in nodes]]
            half += "\f" + "\n".join(line for line in lines if line not in rows).replace("Step-1", f"Step-{n + 1}") + "\n"
        return half

    columns = {"force_x": "CSHEARF.CSHEARF1", "force_y": "CNORMF.CNORMF2"}
    path, middle = tmp_path / "job.rpt", len(x) // 2
    parts = [table(1, range(middle + 1), 1.0).split("\f")[1:], table(2, range(middle, len(x)), 1.0).split("\f")[1:]]
    path.write_text("".join(left + right for left, right in zip(*parts)))
    same(from_fe(path, columns=columns), expected())
    others = table(2, range(middle, len(x)), 1.5).split("\f")[1:]
    path.write_text("".join(left + right for left, right in zip(parts[0], others)))
    with pytest.raises(ValueError, match=rf"node {middle + 1} has several values at the time 1 of Step-1: report one part only"):
        from_fe(path, columns=columns)


def test_report_that_cannot_be_read_whole(tmp_path: Path) -> None:
    """Rows of a narrow page in two lines, and increments that differ by less than the digits of their times."""
    x, _, across, _ = frames()
    path = tmp_path / "job.rpt"
    whole = report([1.0], "COORD.COOR1  CSHEARF.CSHEARF1", lambda n, i: f"{i + 1}  {x[i]:.17g}  {across[n, i]:.17g}", len(x))
    path.write_text(whole.replace("-" * 65 + "\n", "-" * 65 + "\n  CNORMF.CNORMF2\n  @Loc 1\n" + "-" * 65 + "\n"))
    with pytest.raises(
        ValueError, match=r"job.rpt: the rows of its tables are broken into several lines; write it with a wider page"
    ):
        from_fe(path)
    path.write_text(whole + whole.replace("Increment     10", "Increment     11"))
    with pytest.raises(ValueError, match=r"two frames have the time 1; omit one"):
        from_fe(path)


def test_dat_of_calculix(tmp_path: Path) -> None:
    """Forces of two sets; the positions are those of the deck, by set and by sides of elements."""
    x, times, across, along = frames()
    text = ""
    for n, time in enumerate(times):
        text += f"\n displacements (vx,vy,vz) for set TOP and time  {time:.7E}\n\n         1  1.0E+00  1.0E+00  0.0E+00\n"
        for name, factor in (("OTHER", 0.5), ("TOP", 1.0)):
            text += f"\n forces (fx,fy,fz) for set {name} and time  {time:.7E}\n\n"
            text += "".join(
                f"{i + 1:10d} {factor * across[n, i]:.12E} {factor * along[n, i]:.12E}  0.000000E+00\n" for i in range(len(x))
            )
    (tmp_path / "job.dat").write_text(text)
    with pytest.raises(FileNotFoundError, match=r"job.dat: has no positions of nodes; give its input deck as mesh: .*job.inp"):
        from_fe(tmp_path / "job.dat", "TOP")
    deck(tmp_path / "job.inp")
    same(from_fe(tmp_path / "job.dat", "top"), expected())
    with pytest.raises(
        ValueError, match=r"no nodal forces of a set 'SIDE'; there are those of OTHER, TOP; print them: \*NODE PRINT"
    ):
        from_fe(tmp_path / "job.dat", "SIDE")


def test_the_mesh_tells_the_body(tmp_path: Path) -> None:
    path, mesh = tmp_path / "nodes.csv", deck(tmp_path / "job.inp")
    path.write_text("time,node,force_x,force_y\n" + rows_of(lambda t, i, x, fx, fy: f"{t},{i},{fx!r},{fy!r}"))
    same(from_fe(path, "TOP", mesh=mesh), expected())
    with pytest.raises(ValueError, match="faces up at angle=0, so it is that of the lower body, not the upper one"):
        from_fe(path, "TOP", mesh=mesh, body="upper")
    with pytest.raises(ValueError, match="the nodal forces pull at the lower body; with sign=-1"):
        from_fe(path, "TOP", mesh=deck(tmp_path / "above.inp"), sign=-1.0)
    same(from_fe(path, "TOP", mesh=deck(tmp_path / "above.inp", depth=-1.0), sign=-1.0), expected())


def meshio_of(path: Path, n: int) -> Path:
    import meshio

    x, _, across, along = frames()
    size = len(x)
    points = np.column_stack([np.tile(x, 2), np.repeat([0.0, -1.0], size), np.zeros(2 * size)])
    cells = [("quad", np.array([[i, size + i, size + i + 1, i + 1] for i in range(size - 1)]))]
    zero = np.zeros(size)
    force = np.column_stack([np.concatenate([across[n], zero]), np.concatenate([along[n], zero]), np.zeros(2 * size)])
    stress = np.tile([3.0, 0.0, 1.0, 0.0, 0.0, 0.0], (2 * size, 1))
    data = {"forces": force, "stress": stress, "top": np.repeat([1, 0], size)}
    meshio.Mesh(points, cells, point_data=data).write(path)
    return path


def test_vtu_and_pvd(tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    paths = [meshio_of(tmp_path / f"job{n}.vtu", n) for n in range(3)]
    same(from_fe(paths, "top", times=[1.0, 2.0, 3.0]), expected())
    sets = "".join(f'<DataSet timestep="{n + 1}" file="job{n}.vtu"/>' for n in range(3))
    (tmp_path / "job.pvd").write_text(f'<?xml version="1.0"?><VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>')
    loads = from_fe(tmp_path / "job.pvd", "top")
    same(loads, expected())
    assert loads.lower_bulk is not None
    with pytest.raises(ValueError, match=r"no point set or array 'side'; there are point sets none; arrays at points top"):
        from_fe(paths, "side")
    with pytest.raises(ValueError, match="times: 2 numbers for 3 files"):
        from_fe(paths, "top", times=[1.0, 2.0])
    (tmp_path / "bad.vtu").write_text("no mesh")
    with pytest.raises(ValueError, match=r"bad.vtu: meshio cannot read it"):
        from_fe(tmp_path / "bad.vtu", "top")


def test_xdmf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All times in one file."""
    meshio = pytest.importorskip("meshio")
    monkeypatch.chdir(tmp_path)
    frames_of = [meshio.read(meshio_of(tmp_path / f"job{n}.vtu", n)) for n in range(3)]
    with meshio.xdmf.TimeSeriesWriter("job.xdmf") as writer:
        writer.write_points_cells(frames_of[0].points, frames_of[0].cells)
        for n, mesh in enumerate(frames_of):
            writer.write_data(n + 1.0, point_data=mesh.point_data)
    same(from_fe("job.xdmf", "top"), expected())


def test_exodus(tmp_path: Path) -> None:
    """All times of a file, by the name or the number of a node set."""
    netcdf = pytest.importorskip("netCDF4")
    x, times, across, along = frames()
    size = len(x)
    path = tmp_path / "job.e"
    with netcdf.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        for name, length in (
            ("time_step", None),
            ("num_nodes", 2 * size),
            ("len", 33),
            ("vars", 2),
            ("sets", 1),
            ("n", size),
            ("e", size - 1),
        ):
            file.createDimension(name, length)
        file.createDimension("four", 4)
        for name, values in (("coordx", np.tile(x, 2)), ("coordy", np.repeat([0.0, -1.0], size))):
            file.createVariable(name, "f8", ("num_nodes",))[:] = values
        file.createVariable("time_whole", "f8", ("time_step",))[:] = times
        for key, names, length in (("name_nod_var", ["force_x", "force_y"], "vars"), ("ns_names", ["top"], "sets")):
            file.createVariable(key, "S1", (length, "len"))[:] = np.array(
                [list(name.ljust(33, "\0")) for name in names], dtype="S1"
            )
        file.createVariable("ns_prop1", "i4", ("sets",))[:] = [7]
        file.createVariable("node_ns1", "i4", ("n",))[:] = np.arange(1, size + 1)
        for number, values in ((1, across), (2, along)):
            file.createVariable(f"vals_nod_var{number}", "f8", ("time_step", "num_nodes"))[:] = np.hstack([values, 0.0 * values])
        block = file.createVariable("connect1", "i4", ("e", "four"))
        block.elem_type = "QUAD4"
        block[:] = [[i, size + i, size + i + 1, i + 1] for i in range(1, size)]
    same(from_fe(path, "top"), expected())
    same(from_fe(path, "7"), expected())
    with pytest.raises(ValueError, match=r"job.e: no node set 'side'; there are top"):
        from_fe(path, "side")
    (tmp_path / "bad.e").write_text("no mesh")
    with pytest.raises(ValueError, match="not an Exodus file"):
        from_fe(tmp_path / "bad.e", "top")


def test_solid_mesh_of_one_layer(tmp_path: Path) -> None:
    """Nodes behind one another are one; forces are divided by the thickness of the mesh."""
    x, times, across, along = frames()
    size, thickness = len(x), 4.0
    place = [(x[i], y, z) for z in (0.0, thickness) for y in (0.0, -1.0) for i in range(size)]
    lines = ["*NODE", *(f"{n + 1}, {a:.17g}, {b}, {c}" for n, (a, b, c) in enumerate(place)), "*ELEMENT, TYPE=C3D8, ELSET=BODY"]
    for i in range(1, size):
        front = [i, size + i, size + i + 1, i + 1]
        lines.append(", ".join(map(str, [i, *front, *(node + 2 * size for node in front)])))
    top = [*range(1, size + 1), *range(2 * size + 1, 3 * size + 1)]
    lines += ["*NSET, NSET=TOP", *(f"{node}," for node in top)]
    (tmp_path / "job.inp").write_text("\n".join(lines) + "\n")
    text = "time,node,force_x,force_y\n"
    for n, time in enumerate(times):
        for node in top:
            i = (node - 1) % size
            text += f"{time},{node},{0.5 * thickness * across[n, i]:.17g},{0.5 * thickness * along[n, i]:.17g}\n"
    (tmp_path / "job.csv").write_text(text)
    same(from_fe(tmp_path / "job.csv", "TOP", mesh=tmp_path / "job.inp"), expected())


# --- CalculiX ---


def test_pad_of_calculix() -> None:
    """The loads are the resultants that CalculiX prints; stresses of both bodies; tractions at nodes alone would not do."""
    loads = from_fe(RESULTS / "pad.frd", "UPPER_SURFACE", opposite="LOWER_SURFACE")
    assert loads.t.tolist() == [1.0, 2.0]
    np.testing.assert_allclose(loads.P, [144.4622, 99.04391], rtol=1e-6)
    np.testing.assert_allclose(loads.Q, [0.0, 49.62865], atol=1e-5)
    assert abs(loads.M[0]) < 1e-9 and loads.centre == pytest.approx(0.0, abs=1e-9)
    stiffness = 74000.0 / (1.0 - 0.33**2)
    assert loads.lower_bulk is not None and loads.upper_bulk is not None
    stretched = loads.lower_bulk.stress[1] - loads.lower_bulk.stress[0]
    assert stretched == pytest.approx(stiffness * 0.004 / 8.0, rel=0.15)
    half = np.sqrt(8.0 * loads.P[0] * 75.0 / (np.pi * stiffness))
    assert abs(loads.right.x[0] - half) < max(loads.right.x_error[0], 0.3 * half)
    record = read_surface(RESULTS / "pad.frd", "UPPER_SURFACE")
    nodal = from_fe({"x": record.position[:, 0], "pressure": record.fields["pressure"], "shear": record.fields["shear"]})
    assert np.all(nodal.P / loads.P > [1.3, 1.1]), "tractions at nodes of this mesh are too coarse for loads"
    assert np.sign(nodal.Q[1]) == np.sign(loads.Q[1]), "CSHEAR1 of a slave surface above has the sign of Q"


def test_the_pad_of_calculix_upside_down() -> None:
    """Seen from above the pad is the lower body: P and Q are the same, the moment and the edges change places."""
    names = {"opposite": "LOWER_SURFACE"}
    loads = from_fe(RESULTS / "pad.frd", "UPPER_SURFACE", centre=0.3, **names)
    turned = from_fe(RESULTS / "pad.frd", "UPPER_SURFACE", centre=-0.3, angle=180.0, thickness=2.0, **names)
    np.testing.assert_allclose([2.0 * turned.P, 2.0 * turned.Q, 2.0 * turned.M], [loads.P, loads.Q, -loads.M], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(turned.left.x, -loads.right.x, atol=1e-9)
    np.testing.assert_allclose(loads.M, 0.3 * loads.P, rtol=2e-2)
    assert loads.lower_bulk is not None and turned.upper_bulk is not None
    assert turned.upper_bulk.stress[0] == pytest.approx(loads.lower_bulk.stress[0], rel=1e-9)


def test_the_master_surface_of_calculix_has_no_tractions() -> None:
    with pytest.raises(ValueError, match="no compression at any time.*slave surface only"):
        from_fe(RESULTS / "pad.frd", "LOWER_SURFACE")
    with pytest.raises(
        ValueError, match=r"pad.inp: no node set or surface 'PAD'; there are BASE, LEFT, LOWER_SURFACE, RIGHT, TOP, UPPER_SURFACE"
    ):
        from_fe(RESULTS / "pad.frd", "PAD")
    with pytest.raises(ValueError, match="give the node set or surface"):
        from_fe(RESULTS / "pad.frd")


# --- messages ---


@pytest.mark.parametrize(
    ("given", "options", "message"),
    [
        ({"pressure": [1.0]}, {}, "no x; give the positions"),
        ({"x": [0.0, 1.0, 2.0]}, {}, r"neither nodal forces \(force_x, force_y\) nor tractions"),
        ({"x": [0.0, 1.0], "pressure": [0.0, 1.0]}, {}, "has 2 nodes; a contact needs at least 3"),
        ({"x": [0.0, 1.0, 2.0], "pressure": [0.0, np.nan, 0.0]}, {}, "pressure has values that are not numbers"),
        ({"x": [0.0, 1.0, 2.0], "pressure": [0.0, -1.0, 0.0]}, {}, "no compression at any time"),
        ({"x": [0.0, 1.0, 2.0], "pressure": [0.0, 1.0]}, {}, r"pressure has the shape \(1, 2\), not \(times, nodes\) = \(1, 3\)"),
        ({"x": [0.0, 1.0, 2.0], "pressure": [0.0, 1.0, 0.0]}, {"columns": {"p": "x"}}, "columns: unknown quantity 'p'"),
        ({"x": [0.0, 1.0, 2.0], "a": [0.0, 1.0, 0.0]}, {"columns": {"pressure": "b"}}, "no values 'b' for pressure; there are a"),
        ({"x": [0.0, 1.0, 2.0], "pressure": [[0, 1, 0], [0, -1, 0]]}, {}, "pull the bodies apart at time 1"),
        (
            {"x": [0, 1, 2], "pressure": [0, 1, 0], "stress": [0, 0, 0], "sxx": [0, 0, 0], "syy": [0, 0, 0], "sxy": [0, 0, 0]},
            {},
            "give body, 'lower' or 'upper'",
        ),
        ({}, {"body": "left"}, "body: must be 'lower' or 'upper', not 'left'"),
        ({}, {"thickness": 0.0}, "thickness: must be positive, not 0.0"),
        ({}, {"sign": 2.0}, "sign: must be 1 or -1, not 2.0"),
        ({}, {"bulk_range": (2.0, 1.0)}, "bulk_range: must be two increasing numbers"),
    ],
)
def test_what_is_wrong_is_named(given: dict[str, Any], options: dict[str, Any], message: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ValueError, match=message):
            from_fe(given, **options)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.odb", "", "only Abaqus reads an odb"),
        ("a.xyz", "", "unknown format '.xyz'; known are .csv"),
        ("a.frd", "", "has no node sets; give its input deck as mesh"),
        ("a.rpt", "nothing", "has no table of nodes"),
        ("a.csv", "x,pressure\n", "no rows"),
        ("a.csv", "x,pressure\n0,1\n0,1\n1,0\n", "several rows of a time have the same position"),
        ("a.csv", "time,x,pressure\n0,0,1\n0,1,1\n0,2,1\n1,0,1\n", "time 1 has other nodes than the first one"),
        ("a.csv", "time,x,pressure\nsoon,0,1\n", "'soon' is not a time"),
    ],
)
def test_files_that_are_wrong(name: str, text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises((ValueError, OSError), match=message) as caught:
        from_fe(tmp_path / name, "TOP")
    assert name in str(caught.value)


def test_damaged_results_of_calculix(tmp_path: Path) -> None:
    """A file that ends within a block has the times before; other lines are named."""
    text = (RESULTS / "pad.frd").read_text()
    for name in ("pad.inp", "pad.dat"):
        (tmp_path / name).write_text((RESULTS / name).read_text())
    path = tmp_path / "pad.frd"
    path.write_text(text[: text.rindex(" -4  CONTACT") + 2000])
    assert from_fe(path, "UPPER_SURFACE").t.tolist() == [1.0]
    path.write_text(text.replace(" -1         1-8.0", " -1         1-8x0", 1))
    with pytest.raises(ValueError, match=r"pad.frd:\d+: not a line of a formatted .frd file: could not convert"):
        from_fe(path, "UPPER_SURFACE")
    path.write_text("no result\n")
    with pytest.raises(ValueError, match=r"pad.frd: has no results of nodes, or is not a .frd file"):
        from_fe(path, "UPPER_SURFACE")
    with pytest.raises(FileNotFoundError, match=r"absent.frd: does not exist"):
        from_fe(tmp_path / "absent.frd", "UPPER_SURFACE")


def test_from_fe_is_in_loads() -> None:
    assert mfv.loads.from_fe is from_fe
    with pytest.raises(AttributeError, match=r"module 'mfv.loads' has no attribute 'nothing'"):
        mfv.loads.nothing


# --- the command ---


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("nodes.csv").write_text("time,node,x,force_x,force_y\n" + rows_of(lambda t, i, x, fx, fy: f"{t},{i},{x!r},{fx!r},{fy!r}"))
    assert main(["loads", "nodes.csv", "--edges", "edges.csv", "--moment"]) == 0
    printed = capsys.readouterr()
    assert printed.err == "" and "largest P at time 2: P 1.5708, Q 0.3, M" in printed.out
    assert printed.out.splitlines()[-1] == "&history file='nodes_loads.txt' /"
    head, names, *rows = Path("nodes_loads.txt").read_text().splitlines()
    assert head.startswith("# nodes.csv") and names == "time,normal_force,tangential_force,moment" and len(rows) == 3
    assert Path("edges.csv").read_text().splitlines()[1].startswith("time,left_x,left_x_error,left_K_N")
    assert main(["loads", "nodes.csv", "-o", "nodes.csv"]) == 2 and "is the input file" in capsys.readouterr().err
    assert main(["loads", "nodes.csv", "--column", "pressure"]) == 2 and "write KEY=NAME" in capsys.readouterr().err
    assert main(["loads", "nodes.csv", "--body", "upper", "-o", "b.txt"]) == 2
    assert "nodes.csv: the nodal forces pull at the upper body" in capsys.readouterr().err and not Path("b.txt").exists()


def test_errors_and_notes_are_in_the_table(tmp_path: Path) -> None:
    """As comments, with which a case reads it; a body whose surface is not named has no bulk stress, which a note says."""

    def comments(loads: ContactLoads, **options: Any) -> list[str]:
        loads.write(tmp_path / "loads.txt", **options)
        return [line[2:] for line in (tmp_path / "loads.txt").read_text().splitlines() if line.startswith("# ")][1:]

    pad = PROJECT / "examples/fe_pad/pad.frd"
    both = from_fe(pad, "UPPER_SURFACE", opposite="LOWER_SURFACE", centre=0.0)
    assert both.lower_bulk is not None and both.upper_bulk is not None and both.notes
    bulks = {"lower_bulk_stress": both.lower_bulk, "upper_bulk_stress": both.upper_bulk}
    assert comments(both) == [*(f"error of {name}: at most {bulk.error.max():.2g}" for name, bulk in bulks.items()), *both.notes]
    alloy = {"youngs_modulus": 74000.0, "poisson_ratio": 0.33}
    bodies = mfv.Body.half_plane(**alloy), mfv.Body.disk(75.0, elasticity="half_plane", **alloy)
    history = mfv.History(file=tmp_path / "loads.txt")
    read = mfv.Scene(*bodies, mesh=mfv.Mesh(nodes=51), friction=mfv.Friction.coulomb(0.75), history=history).run(check=True)
    assert read.summary.lower_bulk_stress == pytest.approx(both.lower_bulk.stress[-1], rel=1e-9)
    alone = from_fe(pad, "UPPER_SURFACE", centre=0.0)
    assert not any("no bulk stress" in note for note in both.notes)
    assert "no bulk stress of the lower body, so none acts on it; name its surface by opposite" in alone.notes[-1]
    edge = from_fe(arrays(0.03125, 0.4))
    assert comments(edge, edge="right")[0] == f"error of normal_intensity: at most {edge.right.K_N_error.max():.2g}"
