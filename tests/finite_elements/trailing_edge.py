"""How many finite elements, and how much time, the tension at the trailing edge needs: two identical cylinders (half-planes), pressed and
sheared (Cattaneo and Mindlin), by scikit-fem and by MFV, against sigma_xx = 2 mu p0 sqrt(Q/(mu P)) (Johnson 1985, section 7.2).

    pip install scikit-fem; python tests/finite_elements/trailing_edge.py [FRACTION]

FRACTION: Q/(mu P), 0.5 by default. Two minutes on one processor.

Finite elements
---------------
Two identical bodies: the pressure moves both surfaces alike along x and the shear moves them alike along z, so that neither the gap nor the
slip depends on the other traction, and one body is meshed. Equal elements of the size h over |x| <= 1.2 a, a geometric growth of 1.15
outside and in depth, up to 60 a, where the displacement is that of the resultants on a half-plane (the error by the distribution of
the tractions is of the order (a/L)^2). Loads and contact are at nodes: consistent forces of the elements' edges, node to node, as in commercial
programs. The compliance of the nodes in contact comes from one factorisation; active sets iterate between nodes only. The tension is
the largest of the surface nodes, of stresses extrapolated to the nodes and averaged there (least squares from 2 x 2 points), and the largest at
the integration points. Grids are moved by quarters of an element along x, and the worst of four counts: a user does not choose where the edge lies.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
import scipy.sparse.linalg as spl
from skfem import Basis, BilinearForm, ElementQuad1, ElementQuad2, ElementVector, MeshQuad, asm
from skfem.helpers import ddot, eye, sym_grad, trace

import mfv

YOUNG, POISSON, RADIUS, MU = 72100.0, 0.33, 10.0, 0.5
HALF = 0.2
#: m of the pair of identical bodies, half of E*.
PAIR = 0.25 * YOUNG / (1.0 - POISSON**2)
FORCE = math.pi * 2.0 * PAIR * HALF**2 / (4.0 * RADIUS)
PEAK = 2.0 * FORCE / (math.pi * HALF)
GROWTH, FAR, WINDOW = 1.15, 60.0, 1.2
SHIFTS = (0.0, 0.25, 0.5, 0.75)


def exact(fraction: float) -> float:
    return 2.0 * MU * PEAK * math.sqrt(fraction)


def exact_tractions(x: np.ndarray, fraction: float) -> tuple[np.ndarray, np.ndarray]:
    """Pressure and shear of Cattaneo and Mindlin."""
    stick = HALF * math.sqrt(1.0 - fraction)
    whole, inner = (np.sqrt(np.maximum(1.0 - (x / half) ** 2, 0.0)) for half in (HALF, stick))
    return PEAK * whole, MU * PEAK * (whole - stick / HALF * inner)


def towards_edges(smallest: float) -> np.ndarray:
    """Places from beyond the left edge to beyond the right one, `smallest` (over a) apart at both edges, growing away from them."""
    steps = [smallest * HALF]
    while sum(steps) < HALF:
        steps.append(min(GROWTH * steps[-1], 0.1 * HALF))
    inwards = np.cumsum(steps) * HALF / sum(steps)
    outwards = inwards[inwards <= (WINDOW - 1.0) * HALF]
    left = np.concatenate([-HALF - outwards[::-1], [-HALF], -HALF + inwards])
    return np.concatenate([left, -left[-2::-1]])


def grown(start: float, size: float) -> list[float]:
    """Places beyond `start` with a geometric growth of the distances, up to FAR half-widths."""
    places = []
    while start < FAR * HALF:
        size *= GROWTH
        start += size
        places.append(start)
    return places


class Body:
    """A half-plane, z into it, with its stiffness factorised; the contact nodes are those of the window."""

    def __init__(self, elements: int, quadratic: bool, shift: float, middle: np.ndarray | None = None) -> None:
        """`middle`: places of the vertices in the window, instead of equal elements."""
        h = 2.0 * HALF / elements
        count = math.ceil(WINDOW * HALF / h)
        if middle is None:
            middle = h * (np.arange(-count, count + 1) + shift)
        else:
            h = float(np.min(np.diff(middle)))
        beside = np.array(grown(middle[-1], middle[-1] - middle[-2])) - middle[-1]
        x = np.concatenate([middle[0] - beside[::-1], middle, middle[-1] + beside])
        z = np.array([0.0, h, *grown(h, h)])
        self.mesh = MeshQuad.init_tensor(x, z)
        element = ElementVector(ElementQuad2() if quadratic else ElementQuad1())
        self.basis = Basis(self.mesh, element, intorder=4 if quadratic else 2)
        lame, shear = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)

        @BilinearForm
        def stiffness(u, v, _):
            return ddot(lame * eye(trace(sym_grad(u)), 2) + 2 * shear * sym_grad(u), sym_grad(v))

        self.lame, self.shear = lame, shear
        self.matrix = asm(stiffness, self.basis).tocsc()
        places = self.basis.doflocs
        left, right, deep = x[0], x[-1], z[-1]
        outer = (places[0] < left + 1e-9) | (places[0] > right - 1e-9) | (places[1] > deep - 1e-9)
        self.fixed = np.flatnonzero(outer)
        self.free = np.flatnonzero(~outer)
        self.solve = spl.splu(self.matrix[self.free][:, self.free]).solve
        # Component 0 or 1 of each freedom.
        component = np.zeros(self.basis.N, int)
        dofs = self.basis.nodal_dofs
        component[dofs[1]] = 1
        for table in (self.basis.facet_dofs, self.basis.interior_dofs):
            if table.size:
                component[table[1]] = 1
        self.component = component
        surface = (places[1] < 1e-12) & (np.abs(places[0]) <= WINDOW * HALF)
        order = np.argsort(places[0])
        self.tangential = order[(surface & (component == 0))[order]]
        self.normal = order[(surface & (component == 1))[order]]
        self.x = places[0, self.normal]
        self.weight = np.full(self.x.size, h)
        if quadratic:
            ends = np.abs(np.mod(self.x / h - shift + 0.25, 1.0) - 0.25) < 0.1
            self.weight = np.where(ends, h / 3.0, 2.0 * h / 3.0)

    def far(self, normal: float, tangential: float) -> np.ndarray:
        """Displacements of the outer boundary by forces at the origin on a half-plane (Flamant; Johnson 1985, section 2.2)."""
        x, z = self.basis.doflocs[:, self.fixed]
        r2, angle = x * x + z * z, np.arctan2(x, z)
        kappa = 3.0 - 4.0 * POISSON
        c = 1.0 / (4.0 * math.pi * self.shear)
        log = 0.5 * np.log(r2)
        # Into the body by P, along x by Q; potentials of the point force with the stresses sigma_r = -2P cos/(pi r), -2Q sin/(pi r).
        along = c * (normal * (2.0 * x * z / r2 - (kappa - 1.0) * angle) + tangential * (2.0 * x * x / r2 - (kappa + 1.0) * log))
        into = c * (normal * (2.0 * z * z / r2 - (kappa + 1.0) * log) + tangential * (2.0 * x * z / r2 + (kappa - 1.0) * angle))
        return np.where(self.component[self.fixed] == 0, along, into)

    def displacements(self, forces: np.ndarray, normal: float, tangential: float) -> np.ndarray:
        """By forces at all freedoms with these resultants."""
        u = np.zeros(self.basis.N)
        u[self.fixed] = self.far(normal, tangential)
        u[self.free] = self.solve((forces - self.matrix @ u)[self.free])
        return u

    def compliance(self, freedoms: np.ndarray) -> np.ndarray:
        """Displacements of contact nodes by their unit forces, all normal or all tangential."""
        is_normal = float(self.component[freedoms[0]] == 1)
        by_far = self.displacements(np.zeros(self.basis.N), is_normal, 1.0 - is_normal)[freedoms]
        rows = np.searchsorted(self.free, freedoms)
        columns = []
        for row in rows:
            force = np.zeros(self.free.size)
            force[row] = 1.0
            columns.append(self.solve(force)[rows] + by_far)
        matrix = np.array(columns).T
        return 0.5 * (matrix + matrix.T)

    def stresses(self, u: np.ndarray) -> tuple[float, float]:
        """The largest sigma_xx at surface nodes, averaged, and at integration points."""
        gradient = sym_grad(self.basis.interpolate(u))
        sigma = (self.lame + 2 * self.shear) * gradient[0, 0] + self.lame * gradient[1, 1]
        near = np.flatnonzero(np.all(self.mesh.p[1][self.mesh.t] <= 2.0 * np.min(np.diff(np.unique(self.mesh.p[1]))), axis=0))
        # Bilinear from the Gauss points nearest to the corners, to the corners.
        reference = self.basis.X
        lines = np.stack([np.ones(reference.shape[1]), reference[0], reference[1], reference[0] * reference[1]], axis=1)
        fitted = np.linalg.lstsq(lines, sigma[near].T, rcond=None)[0]
        corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
        at_corners = np.stack([np.ones(4), corners[:, 0], corners[:, 1], corners[:, 0] * corners[:, 1]], axis=1) @ fitted
        # The vertex at a corner of the reference element is found by its place.
        places = self.mesh.mapping().F(corners.T, tind=near)
        cells = self.mesh.t[:, near]
        apart = np.abs(places[:, :, :, None] - self.mesh.p[:, cells.T][:, :, None, :]).sum(axis=0)
        vertices = np.take_along_axis(cells.T, apart.argmin(axis=2), axis=1)
        total, count = np.zeros(self.mesh.nvertices), np.zeros(self.mesh.nvertices)
        np.add.at(total, vertices, at_corners.T)
        np.add.at(count, vertices, 1.0)
        on_surface = (self.mesh.p[1] < 1e-12) & (count > 0)
        return float((total[on_surface] / count[on_surface]).max()), float(sigma.max())


def normal_forces(compliance: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Nodal forces of the resultant FORCE, by active sets."""
    touching = np.abs(np.arange(gap.size) - 0.5 * (gap.size - 1)) < 0.4 * gap.size
    for _ in range(100):
        nodes = np.flatnonzero(touching)
        n = nodes.size
        system = np.block([[compliance[np.ix_(nodes, nodes)], -np.ones((n, 1))], [np.ones((1, n)), np.zeros((1, 1))]])
        solution = np.linalg.solve(system, np.append(-gap[nodes], FORCE))
        forces = np.zeros(gap.size)
        forces[nodes] = solution[:-1]
        opened = compliance @ forces + gap - solution[-1]
        following = (touching & (forces > 0.0)) | (~touching & (opened < 0.0))
        if np.array_equal(following, touching):
            return forces
        touching = following
    raise AssertionError


def tangential_forces(compliance: np.ndarray, limit: np.ndarray, force: float) -> np.ndarray:
    """Nodal forces on first loading, by active sets: slip in the direction of the force."""
    touching = limit > 0.0
    slips = np.zeros(limit.size, bool)
    for _ in range(200):
        nodes = np.flatnonzero(touching & ~slips)
        n = nodes.size
        forces = np.where(touching & slips, limit, 0.0)
        system = np.block([[compliance[np.ix_(nodes, nodes)], -np.ones((n, 1))], [np.ones((1, n)), np.zeros((1, 1))]])
        solution = np.linalg.solve(system, np.append(-(compliance @ forces)[nodes], force - forces.sum()))
        forces[nodes] = solution[:-1]
        slip = compliance @ forces - solution[-1]
        following = touching & ((~slips & (forces > limit)) | (slips & (slip < 0.0)))
        if np.array_equal(following, slips):
            return forces
        slips = following
    raise AssertionError


def finite_elements(elements: int, quadratic: bool, shift: float, fraction: float) -> tuple[float, float, float, float]:
    """Relative errors of the tension (contact; contact, at integration points; under the exact tractions), and the processor time."""
    started = time.process_time()
    body = Body(elements, quadratic, shift)
    # The gap of the pair is twice that of one body.
    normal = normal_forces(2.0 * body.compliance(body.normal), body.x**2 / (2.0 * RADIUS))
    shear = tangential_forces(2.0 * body.compliance(body.tangential), MU * normal, fraction * MU * FORCE)
    forces = np.zeros(body.basis.N)
    forces[body.normal], forces[body.tangential] = normal, shear
    nodal, points = body.stresses(body.displacements(forces, normal.sum(), shear.sum()))
    spent = time.process_time() - started
    pressure, traction = exact_tractions(body.x, fraction)
    forces[body.normal], forces[body.tangential] = pressure * body.weight, traction * body.weight
    prescribed, _ = body.stresses(body.displacements(forces, forces[body.normal].sum(), forces[body.tangential].sum()))
    scale = exact(fraction)
    return nodal / scale - 1.0, points / scale - 1.0, prescribed / scale - 1.0, spent


def graded_elements(smallest: float, fraction: float) -> tuple[float, int]:
    """Relative error of the largest averaged stress under the exact tractions on elements that are smallest at the edges, which are
    vertices; and the number of elements along the contact."""
    body = Body(1, False, 0.0, towards_edges(smallest))
    x = body.x
    t, weight = np.polynomial.legendre.leggauss(12)
    middle, half = 0.5 * (x[1:] + x[:-1])[:, None], 0.5 * np.diff(x)[:, None]
    places = middle + half * t
    forces = np.zeros(body.basis.N)
    for freedoms, traction in zip((body.normal, body.tangential), exact_tractions(places, fraction)):
        for side, share in ((slice(None, -1), 0.5 * (1.0 - t)), (slice(1, None), 0.5 * (1.0 + t))):
            forces[freedoms[side]] += (traction * half * share) @ weight
    nodal, _ = body.stresses(body.displacements(forces, forces[body.normal].sum(), forces[body.tangential].sum()))
    return nodal / exact(fraction) - 1.0, int(np.count_nonzero((x[1:] <= HALF * 1.0000001) & (x[:-1] >= -HALF * 1.0000001)))


def half_plane_nodes(nodes: int, shift: float, fraction: float, refined: bool) -> tuple[float, int, float]:
    """Relative error of MFV's tension, its nodes in contact, and the processor time."""
    alloy = {"youngs_modulus": YOUNG, "poisson_ratio": POISSON}
    scene = mfv.Scene(
        mfv.Body.half_plane(**alloy),
        mfv.Body.disk(RADIUS, elasticity="half_plane", **alloy),
        mesh=mfv.Mesh(
            nodes=nodes,
            half_width=WINDOW * HALF * (1.0 + 2.5 * shift / nodes),
            gap="parabolic",
            refine="edges" if refined else "none",
        ),
        friction=mfv.Friction.coulomb(MU),
        steps=[mfv.Step(normal_force=FORCE, friction=False), mfv.Step(tangential_force=fraction * MU * FORCE)],
    )
    started = time.process_time()
    result = mfv.run(scene)
    return (
        result.observables.lower_tension / exact(fraction) - 1.0,
        int(result.summary.contact_nodes),
        time.process_time() - started,
    )


def main() -> None:
    fraction = float(sys.argv[1]) if len(sys.argv) > 1 else 0.5
    print(f"Q/(mu P) = {fraction}; elements or nodes along the contact, worst relative error of four grids, seconds for one")
    for quadratic in (False, True):
        for elements in (10, 20, 40, 80, 160):
            if quadratic and elements > 40:
                continue
            found = np.array([finite_elements(elements, quadratic, shift, fraction) for shift in SHIFTS])
            worst = np.abs(found[:, :3]).max(axis=0)
            print(
                f"{'Q8/Q9' if quadratic else 'Q4'} {elements:4d}: nodes {worst[0]:.1e}, points {worst[1]:.1e}, exact tractions {worst[2]:.1e}, "
                f"{np.median(found[:, 3]):.2f} s",
                flush=True,
            )
    for smallest in (1e-2, 1e-3, 1e-4, 1e-5):
        error, count = graded_elements(smallest, fraction)
        print(f"Q4, exact tractions, {count} elements along the contact, the smallest {smallest:.0e} a: {error:+.1e}", flush=True)
    for refined in (False, True):
        for nodes in (15, 25, 51, 101, 201, 401) if not refined else (60, 100, 200):
            runs = [half_plane_nodes(nodes, shift, fraction, refined) for shift in SHIFTS]
            print(
                f"MFV{' refined' if refined else ''} {runs[0][1]:4d}: {max(abs(error) for error, _, _ in runs):.1e}, "
                f"{np.median([spent for _, _, spent in runs]):.3f} s",
                flush=True,
            )


if __name__ == "__main__":
    main()
