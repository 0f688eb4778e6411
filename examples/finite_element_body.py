"""A body from a finite-element program: its compliance matrix in HDF5, pressed and sheared against the half-plane.

    python examples/finite_element_body.py [--surface-nodes 41] [-o PICTURE.png] [--keep DIRECTORY]

scikit-fem (`pip install scikit-fem`) makes an elastic block, clamped at its bottom and so large that its edges hardly affect
the contact. Unit forces at the surface nodes under the contact give the compliance matrix, which is written to body.h5. A rigid
disk is pressed without friction and then sheared: once on this body, once on an elastic half-plane with nodes at the same
positions. To use another finite-element program, replace the functions `block_mesh` and `surface_compliance`.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad1, ElementVector, MeshQuad
from skfem.models.elasticity import lame_parameters, linear_elasticity

import mfv

SHEAR_MODULUS, POISSON_RATIO = 1.0, 0.3
RADIUS, NORMAL_FORCE, TANGENTIAL_FORCE = 0.25, 1.0e-3, 2.8e-4
#: The nodes of the contact cover [-HALF_WIDTH, HALF_WIDTH]; pressed on, the disk touches [-0.01056, 0.01056] (Hertz).
HALF_WIDTH = 0.0127
#: With fewer nodes the contact would extend beyond the matrix.
FEWEST_NODES = 15
#: Extent of the block to either side and down: about 100 contact half-widths.
REACH = 1.0
#: Each element beyond the fine ones is larger than its neighbour by this factor.
GROWTH = 1.15

CASE = f"""
&scene coupling='full' /
{{body}}
&body shape='disk', radius={RADIUS}, rigid=.true. /
{{mesh}}
&friction law='coulomb', mu=0.7 /
&step normal_force={NORMAL_FORCE}, friction=.false. /
&step tangential_force={TANGENTIAL_FORCE} /
"""
MATRIX = "&body shape='matrix', file='body.h5' /"
HALF_PLANE = f"&body shape='half_plane', shear_modulus={SHEAR_MODULUS}, poisson_ratio={POISSON_RATIO}, datum={{datum:.15g}} /"
QUANTITIES = ("contact half-width", "peak pressure", "stick ratio", "shift")


class Comparison(NamedTuple):
    """The same contact on the finite-element body and on the half-plane."""

    finite_elements: mfv.Result
    half_plane: mfv.Result


def contact_positions(surface_nodes: int) -> np.ndarray:
    """Positions of the surface nodes of the contact: the centres of equal intervals, as in a mesh of MFV."""
    spacing = 2 * HALF_WIDTH / surface_nodes
    return spacing * (np.arange(surface_nodes) - (surface_nodes - 1) / 2)


def graded_distances(spacing: float, fine: float) -> np.ndarray:
    """Increasing distances from 0 to REACH or a little more: steps of `spacing` as far as `fine`, then growing ones."""
    steps = [spacing] * int(np.ceil(fine / spacing))
    while sum(steps) < REACH:
        steps.append(GROWTH * steps[-1])
    return np.cumsum([0.0, *steps])


def block_mesh(x: np.ndarray) -> MeshQuad:
    """The block below y = 0 with mesh nodes at (x, 0): square elements around the contact, coarse ones far away."""
    spacing = x[1] - x[0]
    outside = x[-1] + graded_distances(spacing, 0.25 * HALF_WIDTH)[1:]
    depths = graded_distances(spacing, HALF_WIDTH)
    return MeshQuad.init_tensor(np.concatenate([-outside[::-1], x, outside]), -depths[::-1])


def surface_compliance(mesh: MeshQuad, x: np.ndarray) -> np.ndarray:
    """Displacements of the nodes at (x, 0) by unit forces at them, per unit thickness, in plane strain; shape (2n, 2n).

    Rows and columns in the order of MFV: normal components, positive into the body, of all nodes, then tangential ones,
    positive to the right.
    """
    # Bilinear elements, since the nodal force of MFV is traction times width, which equals the consistent force of linear shape
    # functions on equal elements for uniform traction. Those of quadratic elements alternate: 1/3 of an element's force at shared
    # corners and 2/3 at mid-side nodes, so that traction times width would give a wavy surface.
    basis = Basis(mesh, ElementVector(ElementQuad1()))
    youngs_modulus = 2 * SHEAR_MODULUS * (1 + POISSON_RATIO)
    # The Lame constants of three dimensions make the two-dimensional form plane strain.
    stiffness = linear_elasticity(*lame_parameters(youngs_modulus, POISSON_RATIO)).assemble(basis).tocsc()
    bottom = mesh.nodes_satisfying(lambda p: p[1] == mesh.p[1].min())
    free = np.setdiff1d(np.arange(basis.N), basis.nodal_dofs[:, bottom])

    top = mesh.nodes_satisfying(lambda p: (p[1] == 0.0) & (np.abs(p[0]) <= x[-1]))
    top = top[np.argsort(mesh.p[0, top])]
    right, up = basis.nodal_dofs[:, top]
    loaded = np.concatenate([up, right])
    direction = np.repeat([-1.0, 1.0], len(x))  # into the body is down
    forces = np.zeros((basis.N, len(loaded)))
    forces[loaded, np.arange(len(loaded))] = direction
    factors = splu(stiffness[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    displacements = np.zeros_like(forces)
    displacements[free] = factors.solve(forces[free])
    return direction[:, None] * displacements[loaded]


def write_body(path: Path, x: np.ndarray, compliance: np.ndarray) -> None:
    """The file of a body of the shape 'matrix'. Its surface is flat, so there is no gap."""
    with h5py.File(path, "w") as file:
        file["x"] = x
        file["width"] = np.full_like(x, x[1] - x[0])
        file["compliance"] = compliance


def equivalent_datum(x: np.ndarray, compliance: np.ndarray) -> float:
    """Datum of a half-plane whose displacements equal those of the block.

    A force Q on a half-plane shifts the surface at the distance d by (1 - nu)/(pi G) Q ln(datum/d). The mean over nodes
    more than five elements from the force excludes the discretised singularity.
    """
    tangential = compliance[len(x) :, len(x) :]
    distance = np.abs(x[:, None] - x)
    far = distance > 5.5 * (x[1] - x[0])
    logarithms = np.log(distance[far]) + np.pi * SHEAR_MODULUS / (1 - POISSON_RATIO) * tangential[far]
    return float(np.exp(logarithms.mean()))


def compare(surface_nodes: int, directory: Path) -> Comparison:
    """Both contacts. body.h5 and its case are written to the directory."""
    x = contact_positions(surface_nodes)
    compliance = surface_compliance(block_mesh(x), x)
    write_body(directory / "body.h5", x, compliance)
    case = directory / "finite_element_body.nml"
    case.write_text(CASE.format(body=MATRIX, mesh="&mesh gap='parabolic' /"))
    half_plane = CASE.format(
        body=HALF_PLANE.format(datum=equivalent_datum(x, compliance)),
        mesh=f"&mesh nodes={surface_nodes}, half_width={HALF_WIDTH}, gap='parabolic' /",
    )
    return Comparison(mfv.run(case, check=True), mfv.run(text=half_plane, check=True))


def quantities(result: mfv.Result) -> dict[str, float]:
    """The compared quantities."""
    summary = result.summary
    numbers = (summary.contact_half_width, result.state.pressure.max(), summary.stick_ratio, summary.shift)
    return dict(zip(QUANTITIES, map(float, numbers), strict=True))


def differences(comparison: Comparison) -> dict[str, float]:
    """Relative differences of the finite-element body from the half-plane.

    The approach is not compared: like the shift it contains a rigid translation, which depends on where the bodies
    are held, and the datum has been chosen for the shift.
    """
    numbers, expected = map(quantities, comparison)
    return {name: numbers[name] / expected[name] - 1 for name in QUANTITIES}


def half_width_step(comparison: Comparison) -> float:
    """Relative change of the contact half-width by one more node in contact, its resolution."""
    x = comparison.half_plane.mesh.x
    return float(0.5 * (x[1] - x[0]) / comparison.half_plane.summary.contact_half_width)


def print_table(comparison: Comparison) -> None:
    """Both results and their differences."""
    numbers, expected = map(quantities, comparison)
    print(f"{'':20} {'finite elements':>16} {'half-plane':>12} {'difference':>11}")
    for name, difference in differences(comparison).items():
        percent = round(100 * difference, 3) + 0.0  # no -0.000
        print(f"{name:20} {numbers[name]:16.6g} {expected[name]:12.6g} {percent:10.3f}%")
    print(f"One node at the edge of the contact makes {100 * half_width_step(comparison):.1f}% of its half-width.")


def draw(comparison: Comparison, path: str) -> None:
    """Pressures and shear tractions of both."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(7, 4.2), layout="constrained")
    axes = picture.add_subplot()
    numbers, expected = comparison
    for name, colour in (("pressure", "#0072B2"), ("shear", "#D55E00")):
        axes.plot(expected.mesh.x, expected.state[name], color=colour, label=f"{name}, half-plane")
        axes.plot(numbers.mesh.x, numbers.state[name], "o", color=colour, label=f"{name}, finite elements")
    axes.set(xlabel="x", ylabel="traction / shear modulus", title="Rigid disk on finite elements and on a half-plane")
    axes.legend(frameon=False)
    picture.savefig(path, dpi=180)


@contextlib.contextmanager
def working_directory(kept: Path | None) -> Iterator[Path]:
    """The directory to keep, created if missing, or a temporary one."""
    if kept is None:
        with tempfile.TemporaryDirectory() as directory:
            yield Path(directory)
    else:
        kept.mkdir(parents=True, exist_ok=True)
        yield kept


def main() -> None:
    parser = argparse.ArgumentParser(description="a finite-element body in contact, against the half-plane")
    parser.add_argument("--surface-nodes", type=int, default=41, help="number of surface nodes (default: 41)")
    parser.add_argument("-o", "--output", help="picture to draw")
    parser.add_argument("--keep", type=Path, metavar="DIRECTORY", help="save body.h5 and its case there")
    options = parser.parse_args()
    if options.surface_nodes < FEWEST_NODES:
        parser.error(f"--surface-nodes must be {FEWEST_NODES} or more")
    with working_directory(options.keep) as directory:
        comparison = compare(options.surface_nodes, directory)
    print_table(comparison)
    if options.output:
        draw(comparison, options.output)


if __name__ == "__main__":
    main()
