r"""
Finite-element solution of a frictional contact problem: a rigid parabola (gap x^2/(2R)) pressed on, then sheared over, a coated
half-plane (plane strain), by scikit-fem alone: what tests/python/test_layers.py and docs/verification.md compare MFV with.

    pip install scikit-fem; python tests/finite_elements/coated_cylinder.py [CASES] [LEVEL]

CASES: A (stiff coating), B (soft), H (none: checks against closed forms); all by default, in 24 minutes on two processors and 8 GB.

Conventions
-----------
x along the surface, z INTO the half-plane (surface z=0, interface z=t).
p > 0 : pressure on the half-plane (traction +z).   q : traction on the half-plane along +x.
Punch displacement (dx, dz): dz into the half-plane, dx along +x; NO punch rotation.
sigma_zz(z=0) = -p, sigma_xz(z=0) = -q  (outward normal is -z).
Linear kinematics: the gap is not shifted by dx, normal contact law
      w = u_z - dz + x^2/(2R) >= 0,   p >= 0,   p w = 0
Coulomb, with v the increment of (u_x - dx): |q|<=mu p; v=0 if |q|<mu p; else q = -mu p sign v.

Method
------
* box [-L,L]x[0,L], tensor grid of Q2 quadrilaterals (nested: each level bisects every element).
  Uniform h in the window |x|<=W, geometric growth outside and in depth.
* outer boundary: displacement of the Flamant solution of the SUBSTRATE half-plane for each load
  (error O(t/L) in the displacement there, i.e. strain error near the contact O(a t/L^2)).
* compliance of the surface by FE: unit hat tractions (p and q piecewise linear between the
  vertices of the surface edges) -> hat-weighted mean displacements (Galerkin, symmetric).
* incremental frictional contact: primal-dual active set, full coupling, memory of slip.
* one more FE solve with the final tractions -> stresses.  Interface tractions in two ways:
  'dir'  : mean of the stresses evaluated just above and just below (vertex average),
  'cons' : consistent nodal forces of the coating elements divided by the edge mass matrix.
"""

import json
import sys
import time

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from skfem import Basis, BilinearForm, ElementQuad1, ElementQuad2, ElementVector, FacetBasis, MeshQuad, asm
from skfem.helpers import ddot, eye, sym_grad, trace

R, MU, ES, NUS = 1000.0, 0.5, 100.0, 0.30
P_TOT = np.pi * ES / (4 * R * (1 - NUS**2))  # a = 1 on the bare substrate (Hertz)
QRATIO = 0.5  # Q = QRATIO*mu*P at the end
CASES = {
    "H": dict(E=ES, nu=NUS, t=0.5, W=1.2),  # homogeneous: verification
    "A": dict(E=400.0, nu=0.25, t=0.5, W=0.96),
    "B": dict(E=20.0, nu=0.45, t=0.3, W=1.4),
}


# ----------------------------------------------------------------------------- mesh
def grow(start, h, g, stops, L):
    """coarse 1-D grid from `start`, steps h(1+g)^k, hitting every point of `stops`, up to >= L."""
    pts, x, s = [start], start, h
    for st in list(stops) + [None]:
        if st is None:
            while x < L:
                s *= 1 + g
                x += s
                pts.append(x)
        else:
            seg, ss, y = [], s, x
            while y < st - 1e-12:
                ss *= 1 + g
                y += ss
                seg.append(ss)
            seg = np.array(seg) * (st - x) / np.sum(seg)  # scale to land on the stop
            pts += list(x + np.cumsum(seg))
            x, s = st, seg[-1]
    return np.array(pts)


def bisect(x, n):
    for _ in range(n):
        y = np.empty(2 * len(x) - 1)
        y[::2], y[1::2] = x, 0.5 * (x[1:] + x[:-1])
        x = y
    return x


def grid(W, t, level, L, h0=0.04, g=0.60):
    n = round(W / h0)
    xp = grow(W, h0, g, [5.0], L)
    xp = np.concatenate([np.linspace(0, W, n + 1), xp[1:]])
    nz = int(np.ceil(t / (1.6 * h0)))
    r = np.linspace(1.0, 1.5, nz)
    zc = np.concatenate([[0], np.cumsum(r) / r.sum() * t])
    z = np.concatenate([zc, grow(t, zc[-1] - zc[-2], g, [], L)[1:]])
    xp = np.concatenate([-xp[:0:-1], xp])
    return bisect(xp, level), bisect(z, level)


# ----------------------------------------------------------------------------- linear algebra
class Solver:
    """factor once, solve many.  PARDISO (Cholesky) if there, else SuperLU."""

    def __init__(self, K):
        try:
            from pypardiso import PyPardisoSolver

            self.s = PyPardisoSolver(mtype=2)
            self.K = sp.triu(K, format="csr")
            self.K.sort_indices()
            self.s.factorize(self.K)
            self.kind = "pardiso"
        except ImportError:
            self.lu = spl.splu(K.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=dict(SymmetricMode=True))
            self.kind = "superlu"

    def solve(self, B):
        if self.kind == "pardiso":
            return self.s.solve(self.K, np.asfortranarray(B))
        return self.lu.solve(B)

    def free(self):
        if self.kind == "pardiso":
            self.s.free_memory(everything=True)


def flamant(x, z, X, Z, E, nu):
    """displacement (u_x,u_z) of the half-plane z>0 under a surface point force (X,Z) at 0.
    The free translation is chosen so that u respects the mirror symmetry x -> -x (theta-pi/2)."""
    G, kap = E / (2 * (1 + nu)), 3 - 4 * nu
    ze = x + 1j * np.maximum(z, 0.0)
    lr, th = np.log(np.abs(ze)), np.angle(ze) - np.pi / 2
    F = X + 1j * Z
    u = (-F * (kap * (lr + 1j * th) + (lr - 1j * th)) + np.conj(F) * ze / np.conj(ze)) / (4 * np.pi * G)
    return u.real, u.imag


class FE:
    def __init__(self, E, nu, t, W, level, L):
        tic = time.time()
        self.E, self.nu, self.t, self.W = E, nu, t, W
        gx, gz = grid(W, t, level, L)
        self.gx, self.gz = gx, gz
        self.m = m = MeshQuad.init_tensor(gx, gz)
        self.h = 0.04 / 2**level
        self.Lx, self.Lz = gx[-1], gz[-1]
        cz = m.p[1, m.t].mean(axis=0)
        self.coat = np.nonzero(cz < t)[0]
        self.vb = vb = Basis(m, ElementVector(ElementQuad2()), intorder=4)
        Ee = np.where(cz < t, E, ES)[:, None] * np.ones(vb.dx.shape)
        ne = np.where(cz < t, nu, NUS)[:, None] * np.ones(vb.dx.shape)
        self.lam, self.G = Ee * ne / ((1 + ne) * (1 - 2 * ne)), Ee / (2 * (1 + ne))

        @BilinearForm
        def elas(u, v, w):
            e = sym_grad(u)
            return ddot(w["lam"] * eye(trace(e), 2) + 2 * w["G"] * e, sym_grad(v))

        self.elas = elas
        K = asm(elas, vb, lam=self.lam, G=self.G).tocsr()
        N = self.N = K.shape[0]
        # scalar dof -> vector dof
        sb = Basis(m, ElementQuad2(), intorder=4)
        mp = np.empty((2, sb.N), dtype=int)
        for c in (0, 1):
            for nm in ("nodal_dofs", "facet_dofs", "interior_dofs"):
                mp[c, getattr(sb, nm)[0]] = getattr(vb, nm)[c]
        self.mp, self.sx = mp, sb.doflocs
        # outer boundary
        out = (np.abs(np.abs(sb.doflocs[0]) - self.Lx) < 1e-9) | (np.abs(sb.doflocs[1] - self.Lz) < 1e-9)
        self.outs = np.nonzero(out)[0]
        D = self.D = np.concatenate([mp[0, self.outs], mp[1, self.outs]])
        free = self.I = np.setdiff1d(np.arange(N), D)
        self.KID = K[free][:, D].tocsr()
        # hat tractions on the window (interior vertices of the window)
        top = m.facets_satisfying(lambda x: (np.abs(x[1]) < 1e-12) & (np.abs(x[0]) < W))
        f2, f1 = FacetBasis(m, ElementQuad2(), facets=top, intorder=4), FacetBasis(m, ElementQuad1(), facets=top, intorder=4)
        mass = BilinearForm(lambda u, v, w: u * v)
        B = asm(mass, f1, f2).tocsc()  # (Q2 rows, Q1 cols)
        nod = np.nonzero((np.abs(m.p[1]) < 1e-12) & (np.abs(m.p[0]) < W - 1e-9))[0]
        nod = nod[np.argsort(m.p[0, nod])]
        self.x = m.p[0, nod]
        Bs = B[:, f1.nodal_dofs[0, nod]]
        M = self.M = len(nod)
        self.wt = np.asarray(Bs.sum(axis=0)).ravel()  # int phi_j
        self.Bx = sp.csr_matrix((Bs.tocoo().data, (mp[0, Bs.tocoo().row], Bs.tocoo().col)), (N, M))
        self.Bz = sp.csr_matrix((Bs.tocoo().data, (mp[1, Bs.tocoo().row], Bs.tocoo().col)), (N, M))
        # hat-weighted mean of x^2/(2R) : x_j^2/(2R) + h^2/(12R)
        self.gap = self.x**2 / (2 * R) + self.h**2 / (12 * R)
        self.sol = Solver(K[free][:, free])
        self.tfac = time.time() - tic

    def bc(self, pw, qw):
        """Flamant displacement on D of point forces pw (z), qw (x) at the nodes (columns = load cases)."""
        X, Z = self.sx[0, self.outs], self.sx[1, self.outs]
        ux = np.zeros((len(X), pw.shape[1]))
        uz = np.zeros_like(ux)
        for j in np.nonzero(np.any(pw != 0, 1) | np.any(qw != 0, 1))[0]:
            for k, w in ((0, qw[j]), (1, pw[j])):
                a, b = flamant(X - self.x[j], Z, 1.0 - k, float(k), ES, NUS)
                ux += np.outer(a, w)
                uz += np.outer(b, w)
        return np.vstack([ux, uz])

    def displ(self, p, q):
        """FE displacement (N x k) for nodal tractions p,q (M x k)."""
        UD = self.bc(p * self.wt[:, None], q * self.wt[:, None])
        U = np.zeros((self.N, p.shape[1]))
        U[self.D] = UD
        f = self.Bz @ p + self.Bx @ q
        U[self.I] = self.sol.solve(np.asarray(f[self.I]) - self.KID @ UD).reshape(len(self.I), -1)
        return U

    def compliance(self, block=64):
        """C[d][e]: mean displacement d (0=x,1=z) at hat i from unit nodal traction e at hat j.
        Uses the mirror symmetry x -> -x (the mesh is symmetric): half of the columns solved."""
        tic = time.time()
        M = self.M
        C = np.zeros((2, 2, M, M))
        half = np.arange((M + 1) // 2)
        for e in (0, 1):
            for s in range(0, len(half), block):
                J = half[s : s + block]
                z = np.zeros((M, len(J)))
                o = z.copy()
                o[J, np.arange(len(J))] = 1.0
                U = self.displ(o, z) if e == 1 else self.displ(z, o)
                for d, B in ((0, self.Bx), (1, self.Bz)):
                    C[d, e][:, J] = (B.T @ U) / self.wt[:, None]
        for e in (0, 1):
            for d in (0, 1):
                sgn = 1.0 if d == e else -1.0
                J = np.arange((M + 1) // 2, M)
                C[d, e][:, J] = sgn * C[d, e][::-1, :][:, M - 1 - J]
        self.tcomp = time.time() - tic
        S = (
            self.wt[
                :,
                None,
            ]
            * C[1, 1]
        )
        self.asym = np.abs(S - S.T).max() / np.abs(S).max()
        return C

    # ------------------------------------------------------------------ post-processing
    def stress_at(self, U, elems, zref):
        """stresses averaged over the two elements meeting at each vertex of the row z=zref."""
        m = self.m
        pts = np.array([[0, 1, 0, 1, 0.5, 0.5, 0, 1], [0, 0, 1, 1, 0, 1, 0.5, 0.5]], float)
        vb = Basis(m, ElementVector(ElementQuad2()), elements=elems, quadrature=(pts, np.ones(8) / 8))
        u = vb.interpolate(U)
        X = np.asarray(vb.global_coordinates())
        g = u.grad
        exx, ezz, exz = g[0, 0], g[1, 1], 0.5 * (g[0, 1] + g[1, 0])
        z = m.p[1, m.t[:, elems]].mean(axis=0)
        E = np.where(z < self.t, self.E, ES)[:, None]
        nu = np.where(z < self.t, self.nu, NUS)[:, None]
        lam, G = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
        tr = exx + ezz
        s = dict(xx=lam * tr + 2 * G * exx, zz=lam * tr + 2 * G * ezz, xz=2 * G * exz, exx=exx)
        on = np.abs(X[1] - zref) < 1e-9
        x = X[0][on]
        key = np.round(x, 9)
        ux, inv = np.unique(key, return_inverse=True)
        cnt = np.bincount(inv)
        return ux, {k: np.bincount(inv, v[on]) / cnt for k, v in s.items()}

    def post(self, U, p, q, xmax=3.0):
        m, t = self.m, self.t
        ex = np.abs(m.p[0, m.t]).max(axis=0) < xmax + 0.6
        zlo, zhi = m.p[1, m.t].min(axis=0), m.p[1, m.t].max(axis=0)
        up = np.nonzero(ex & (np.abs(zhi - t) < 1e-9))[0]
        lo = np.nonzero(ex & (np.abs(zlo - t) < 1e-9))[0]
        sf = np.nonzero(ex & (np.abs(zlo) < 1e-9))[0]
        vx = self.gx[np.abs(self.gx) <= xmax]  # vertices only

        def pick(x, d):
            return {k: np.interp(vx, x, v) for k, v in d.items()}

        a = pick(*self.stress_at(U, up, t))
        b = pick(*self.stress_at(U, lo, t))
        s = pick(*self.stress_at(U, sf, 0.0))
        # consistent interface tractions
        cb = Basis(m, ElementVector(ElementQuad2()), elements=self.coat, intorder=4)
        len(self.coat)
        Kc = asm(self.elas, cb, lam=self.lam[self.coat], G=self.G[self.coat])
        F = Kc @ U
        fac = m.facets_satisfying(lambda x: np.abs(x[1] - t) < 1e-9)
        fb = FacetBasis(m, ElementQuad2(), facets=fac, intorder=4)
        Mm = asm(BilinearForm(lambda u, v, w: u * v), fb).tocsr()
        sd = np.nonzero(np.abs(self.sx[1] - t) < 1e-9)[0]
        sd = sd[np.argsort(self.sx[0, sd])]
        lu = spl.splu(Mm[sd][:, sd].tocsc())
        tz, tx = lu.solve(F[self.mp[1, sd]]), lu.solve(F[self.mp[0, sd]])  # traction ON the coating
        szz_c = np.interp(vx, self.sx[0, sd], tz)
        sxz_c = np.interp(vx, self.sx[0, sd], tx)
        pin = np.interp(vx, np.r_[-1e9, -self.W, self.x, self.W, 1e9], np.r_[0, 0, p, 0, 0])
        sxx_surf = self.E / (1 - self.nu**2) * s["exx"] - self.nu / (1 - self.nu) * pin
        return dict(
            x=vx,
            int_szz_dir=0.5 * (a["zz"] + b["zz"]),
            int_sxz_dir=0.5 * (a["xz"] + b["xz"]),
            int_szz_cons=szz_c,
            int_sxz_cons=sxz_c,
            int_szz_jump=a["zz"] - b["zz"],
            int_sxz_jump=a["xz"] - b["xz"],
            int_sxx_above=a["xx"],
            int_sxx_below=b["xx"],
            surf_sxx=sxx_surf,
            surf_szz_fe=s["zz"],
            surf_sxz_fe=s["xz"],
        )

    def surf_u(self, U, xq):
        """surface displacement (u_x,u_z) at the points xq (Q2 interpolation along the edge)."""
        sd = np.nonzero(np.abs(self.sx[1]) < 1e-12)[0]
        sd = sd[np.argsort(self.sx[0, sd])]
        X = self.sx[0, sd]
        out = []
        for x in xq:
            k = np.searchsorted(X[::2], x, side="right") - 1
            k = min(max(k, 0), (len(X) - 1) // 2 - 1)
            i = [2 * k, 2 * k + 1, 2 * k + 2]
            s = (x - X[i[0]]) / (X[i[2]] - X[i[0]])
            N = np.array([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)])
            out.append([N @ U[self.mp[0, sd[i]]], N @ U[self.mp[1, sd[i]]]])
        return np.array(out)


# ----------------------------------------------------------------------------- friction
class Contact:
    def __init__(self, x, wt, gap, C, mu, coupled=True):
        self.x, self.wt, self.gap, self.mu = x, wt, gap, mu
        self.Cxx, self.Cxz, self.Czx, self.Czz = C[0, 0], C[0, 1], C[1, 0], C[1, 1]
        self.coupled = coupled
        if not coupled:
            self.Cxz = 0 * self.Cxz
            self.Czx = 0 * self.Czx
        M = len(x)
        self.p, self.q, self.ux = np.zeros(M), np.zeros(M), np.zeros(M)
        self.dx = self.dz = 0.0
        self.con = np.abs(x) < 1e-9
        self.st = np.zeros(M, int)  # 0 stick, +-1 slip with q=st*mu*p
        self.iters = self.bad = 0

    def _solve(self, con, st, P, Q):
        A = np.nonzero(con)[0]
        S = np.nonzero(con & (st == 0))[0]
        nA, nS, mu = len(A), len(S), self.mu
        sg = st[A] * mu
        K = np.zeros((nA + nS + 2,) * 2)
        f = np.zeros(nA + nS + 2)
        iz, ix = nA + nS, nA + nS + 1
        K[:nA, :nA] = self.Czz[np.ix_(A, A)] + self.Czx[np.ix_(A, A)] * sg
        K[:nA, nA:iz] = self.Czx[np.ix_(A, S)]
        K[:nA, iz] = -1
        f[:nA] = -self.gap[A]
        K[nA:iz, :nA] = self.Cxz[np.ix_(S, A)] + self.Cxx[np.ix_(S, A)] * sg
        K[nA:iz, nA:iz] = self.Cxx[np.ix_(S, S)]
        K[nA:iz, ix] = -1
        f[nA:iz] = self.ux[S] - self.dx
        K[iz, :nA] = self.wt[A]
        f[iz] = P
        K[ix, :nA] = self.wt[A] * sg
        K[ix, nA:iz] = self.wt[S]
        f[ix] = Q
        sc = self.Czz[A[0], A[0]]  # scale the rows and columns
        D = np.ones(nA + nS + 2)
        D[:iz] = 1 / np.sqrt(sc)
        D[iz:] = np.sqrt(sc)
        y = D * np.linalg.solve(D[:, None] * K * D, D * f)
        p = np.zeros(len(self.x))
        q = p.copy()
        p[A] = y[:nA]
        q[A] = sg * y[:nA]
        q[S] = y[nA:iz]
        return p, q, y[iz], y[ix]

    def step(self, P, Q, maxit=300):
        con, mu = self.con.copy(), self.mu
        st = self.st.copy()
        seen = set()
        for it in range(maxit):
            if not np.any(con & (st == 0)):
                st[np.argmin(np.abs(self.x))] = 0
            p, q, dz, dx = self._solve(con, st, P, Q)
            uz = self.Czz @ p + self.Czx @ q
            ux = self.Cxz @ p + self.Cxx @ q
            w = uz - dz + self.gap
            v = (ux - self.ux) - (dx - self.dx)
            ps, ws = p.max(), np.abs(self.gap).max()
            leave = con & (p < 0)
            enter = ~con & (w < -1e-13 * ws)
            tosl = con & (st == 0) & (np.abs(q) > mu * p * (1 + 1e-10) + 1e-13 * ps) & ~leave
            tost = con & (st != 0) & (st * v > 1e-12 * ws) & ~leave
            if not (leave.any() or enter.any() or tosl.any() or tost.any()):
                break
            key = (con.tobytes(), st.tobytes())
            cyc = key in seen
            seen.add(key)
            if cyc:  # cycling: one change only (largest)
                best = []
                if leave.any():
                    i = np.argmin(np.where(leave, p, 0))
                    best.append((-p[i] / ps, "l", i))
                if enter.any():
                    i = np.argmin(np.where(enter, w, 0))
                    best.append((-w[i] / ws, "e", i))
                if tosl.any():
                    ex = np.where(tosl, np.abs(q) - mu * p, -1)
                    i = np.argmax(ex)
                    best.append((ex[i] / ps, "s", i))
                if tost.any():
                    ex = np.where(tost, st * v, -1)
                    i = np.argmax(ex)
                    best.append((ex[i] / ws, "t", i))
                _, k, i = max(best) if it % 2 else best[np.random.default_rng(it).integers(len(best))]
                one = np.zeros_like(con)
                one[i] = True
                leave, enter, tosl, tost = (one & (k == c) for c in "lest")
            st = np.where(tosl, np.sign(q).astype(int), st)
            st = np.where(tost, 0, st)
            if enter.any():  # a new node takes its neighbour's state
                ci = np.nonzero(con)[0]
                for i in np.nonzero(enter)[0]:
                    st[i] = st[ci[np.argmin(np.abs(ci - i))]]
            con = (con & ~leave) | enter
        else:
            self.bad += 1
        self.iters += it + 1
        self.con, self.st = con, st
        self.p, self.q, self.ux, self.dz, self.dx, self.w = p, q, ux, dz, dx, w
        self.uz = uz

    # sub-grid edges ----------------------------------------------------------
    def edges(self, m_stick, eps):
        """Contact edges: near the edge p ~ r^lam, lam = 1/2 +- eps in a slip zone (q outward / inward
        on the half-plane; tan(pi eps) = mu (1-2nu)/(2(1-nu)) of the coating), 1/2 if it sticks;
        p^(1/lam) is fitted by a parabola over nodes 3..11 from the edge.
        Stick edges: with s the sign of the slip traction outside, (mu p - s q)^(1/m) is fitted,
        m=1/2 (receding stick: shear phase) or 3/2 (advancing stick: press)."""
        x, h, out = self.x, self.x[1] - self.x[0], {}
        ci = np.nonzero(self.con)[0]
        s = np.nonzero(self.con & (self.st == 0))[0]

        def root(i, y, deg, x0, lo, hi):
            c = np.polyfit((x[i] - x0) / h, y / np.abs(y).max(), deg)
            r = np.roots(c)
            r = np.real(r[np.abs(np.imag(r)) < 1e-9])
            r = r[(r >= lo) & (r <= hi)]
            return x0 + h * r[np.argmin(np.abs(r))] if len(r) else np.nan

        for side, e, o, se in (("L", ci[0], 1, s[0]), ("R", ci[-1], -1, s[-1])):
            nslip = abs(se - e)
            lam = 0.5
            if nslip >= 3:
                lam = 0.5 + eps if self.st[e] * (-o) > 0 else 0.5 - eps
            nn = 12 if nslip < 3 else min(12, nslip)
            i = e + o * np.arange(3, max(nn, 7))
            lo, hi = (-6, 3) if o > 0 else (-3, 6)
            z = root(i, self.p[i] ** (1 / lam), 2, x[e], lo, hi)
            out["a" + side] = z if np.isfinite(z) else x[e] - 0.5 * o * h
            # stick edge: outermost stick node se, first slip node outside se-o
            sg = self.st[se - o] if self.con[se - o] else 0
            mid = x[se] - 0.5 * o * h
            z = np.nan
            if sg != 0 and len(s) > 24:
                i = se + o * np.arange(2, 10)
                y = np.maximum(self.mu * self.p[i] - sg * self.q[i], 0) ** (1 / m_stick)
                lo, hi = (-3.0, 1.5) if o > 0 else (-1.5, 3.0)
                z = root(i, y, 2 if m_stick < 1 else 1, x[se], lo, hi)
            out["c" + side] = z if np.isfinite(z) else mid
            out["c" + side + "_fit_ok"] = bool(np.isfinite(z))
            out["c" + side + "_node"] = x[se]
            out["a" + side + "_node"] = x[e]
            out["c" + side + "_at_edge"] = bool(nslip < 3)
        out["stick_contiguous"] = bool(np.all(np.diff(s) == 1))
        return out


def peak(x, p):
    """5-point least-squares parabola around the largest node"""
    i = int(np.argmax(p))
    d = x[1] - x[0]
    c = np.polyfit(np.arange(-2, 3), p[i - 2 : i + 3], 2)
    z = np.clip(-c[1] / (2 * c[0]), -2, 2)
    return np.polyval(c, z), x[i] + z * d


def report(fe, c, U, m_stick):
    """all scalar results of one state"""
    eps = 0.0 if not c.coupled else np.arctan(c.mu * (1 - 2 * fe.nu) / (2 * (1 - fe.nu))) / np.pi
    e = c.edges(m_stick, eps)
    x, w, p, q = c.x, c.wt, c.p, c.q
    p0, xp0 = peak(x, p)
    a = 0.5 * (e["aR"] - e["aL"])
    r = dict(
        **e,
        a=a,
        x_centre=0.5 * (e["aR"] + e["aL"]),
        p0=p0,
        x_p0=xp0,
        p_at_0=p[np.argmin(np.abs(x))],
        P=w @ p,
        Q=w @ q,
        abs_q_int=w @ np.abs(q),
        x_mean=w @ (p * x) / (w @ p),
        x_rms=np.sqrt(w @ (p * x**2) / (w @ p) + fe.h**2 / 6),
        q_max=q.max(),
        x_q_max=x[np.argmax(q)],
        q_min=q.min(),
        x_q_min=x[np.argmin(q)],
        q_at_0=q[np.argmin(np.abs(x))],
        q_abs_max=np.abs(q).max(),
        mu_p_at_cL=c.mu * np.interp(e["cL"], x, p),
        mu_p_at_cR=c.mu * np.interp(e["cR"], x, p),
    )
    r["c_half"] = 0.5 * (e["cR"] - e["cL"])
    for nm, d in (("5", 5.0), ("5a", 5 * a)):
        u = fe.surf_u(U, [-d, d])
        r["approach_" + nm] = c.dz - u[:, 1].mean()
        r["tilt_uz_" + nm] = u[1, 1] - u[0, 1]
        r["dx_rel_" + nm] = c.dx - u[:, 0].mean()
        r["ux_diff_" + nm] = u[1, 0] - u[0, 0]
    return {k: (v if isinstance(v, bool) else float(v)) for k, v in r.items()}


def run_load(fe, C, n_press, n_shear, coupled=True, mu=MU, qratio=QRATIO, fe_post=True):
    """press with P ~ k^2 (contact width about linear in k), then shear at constant P."""
    c = Contact(fe.x, fe.wt, fe.gap, C, mu, coupled)
    tic = time.time()
    res, sf = {}, dict(x=fe.x)

    def state(name, m_stick):
        U = fe.displ(c.p[:, None], c.q[:, None])[:, 0]
        res[name] = report(fe, c, U, m_stick)
        if fe_post:
            res[name + "_prof"] = fe.post(U, c.p, c.q)
        sf["p_" + name], sf["q_" + name] = c.p.copy(), c.q.copy()
        sf["state_" + name] = np.where(c.con, c.st, 9)  # 0 stick, +-1 slip, 9 open
        sf["ux_rel_" + name] = c.ux - c.dx  # surface minus punch (hat means)

    for k in range(1, n_press + 1):
        c.step(P_TOT * (k / n_press) ** 2, 0.0)
    state("press", 1.5)
    for k in range(1, n_shear + 1):
        c.step(P_TOT, qratio * mu * P_TOT * k / n_shear)
    if n_shear:
        state("shear", 0.5)
    res["surf"] = sf
    res["meta"] = dict(
        h=fe.h,
        L=float(fe.Lx),
        depth=float(fe.Lz),
        dofs=int(fe.N),
        M=int(fe.M),
        n_press=n_press,
        n_shear=n_shear,
        iterations=c.iters,
        failed_steps=c.bad,
        t_load=time.time() - tic,
        t_factor=fe.tfac,
        t_compliance=fe.tcomp,
        asymmetry=float(fe.asym),
    )
    return res


# ----------------------------------------------------------------------------- verification
def hertz_D(a, d):
    """u_z(0)-u_z(d), d>=a, of the Hertz pressure of half-width a on the half-plane (curvature 1/R)"""

    def F(x):
        return 0.5 * (x * x - x * np.sqrt(x * x - a * a) + a * a * np.log(x + np.sqrt(x * x - a * a)))

    return (a * a / 2 + F(d) - F(a)) / R


def mcewen(x, z, a, p0):
    """stresses of the pressure p0 sqrt(1-x^2/a^2) and of the shear traction q0 = p0 of the same form"""
    A = a * a - x * x + z * z
    B = np.sqrt(A * A + 4 * x * x * z * z)
    m = np.sqrt(np.maximum(0.5 * (B + A), 0))
    n = np.sign(x) * np.sqrt(np.maximum(0.5 * (B - A), 0))
    mn = m * m + n * n + 1e-300
    sx = -p0 / a * (m * (1 + (z * z + n * n) / mn) - 2 * z)
    sz = -p0 / a * m * (1 - (z * z + n * n) / mn)
    txz = -p0 / a * n * (m * m - z * z) / mn
    sxq = p0 / a * (n * (2 - (z * z - m * m) / mn) - 2 * x)
    return sx, sz, txz, sxq, txz, sx  # (xx,zz,xz) of p ; (xx,zz,xz) of q


def verify_uncoupled(r):
    """errors of an uncoupled homogeneous run against Hertz / Cattaneo-Mindlin"""
    a = 1.0
    p0 = 2 * P_TOT / np.pi
    c = np.sqrt(1 - QRATIO)
    pr, sh = r["press"], r["shear"]
    d = 5.0
    ex = dict(a=a, p0=p0, approach_5=hertz_D(a, d), x_rms=0.5)
    out = {"press_" + k: [pr[k], v, pr[k] / v - 1] for k, v in ex.items()}
    qpk = MU * p0 * np.sqrt(1 - c * c)
    ex = dict(c_half=c, mu_p_at_cR=qpk, q_max=qpk, dx_rel_5=MU * (hertz_D(a, d) - hertz_D(c, d)), q_at_0=MU * p0 * (1 - c))
    out.update({"shear_" + k: [sh[k], v, sh[k] / v - 1] for k, v in ex.items()})
    for nm in ("press", "shear"):
        f = r[nm + "_prof"]
        x = f["x"]
        for lev, z in (("int", 0.5), ("surf", 1e-9)):
            sx, sz, t, _sxq, _szq, _tq = mcewen(x, z, a, p0)
            if nm == "shear":
                _, _, _, b1, b2, b3 = mcewen(x, z, a, MU * p0)
                _, _, _, d1, d2, d3 = mcewen(x, z, c, MU * p0 * c)
                sx, sz, t = sx + b1 - d1, sz + b2 - d2, t + b3 - d3
            if lev == "int":
                for k, v in (
                    ("int_szz_dir", sz),
                    ("int_szz_cons", sz),
                    ("int_sxz_dir", t),
                    ("int_sxz_cons", t),
                    ("int_sxx_above", sx),
                    ("int_sxx_below", sx),
                ):
                    out[nm + "_" + k + "_maxerr/p0"] = float(np.abs(f[k] - v).max() / p0)
            else:
                ok = np.ones(len(x), bool)
                for e in (-a, a) if nm == "press" else (-a, a, -c, c):
                    ok &= np.abs(x - e) > 0.05
                out[nm + "_surf_sxx_maxerr/p0 (0.05 off the edges)"] = float(np.abs(f["surf_sxx"] - sx)[ok].max() / p0)
    return out


def exact_compliance(fe):
    """hat-averaged compliance of the homogeneous half-plane (closed form), up to the datum"""
    h, x = fe.h, fe.x
    E, nu = ES, NUS
    D = x[:, None] - x[None, :]
    k = np.array([1, -4, 6, -4, 1.0]) / h**2
    sh = np.arange(-2, 3) * h
    X = D[..., None] + sh
    with np.errstate(divide="ignore", invalid="ignore"):
        L4 = np.where(np.abs(X) > 1e-12, X**4 / 24 * (np.log(np.abs(X)) - 25 / 12), 0)
    logk = (L4 @ k) / h  # mean over hat i of int phi_j ln|x-s| ds
    sgk = ((np.sign(X) * X**4 / 24) @ k) / h
    Cs = -2 * (1 - nu**2) / (np.pi * E) * logk
    Cz = (1 - 2 * nu) * (1 + nu) / (2 * E) * sgk
    return np.array([[Cs, -Cz], [Cz, Cs]])  # [[xx, xz],[zx, zz]]


def verify_compliance(fe, C):
    """action of the FE and of the closed-form compliance on the Hertz shape sqrt(1-x^2) and on
    x sqrt(1-x^2): largest difference / range, free datum removed (single entries near the diagonal
    see the element size = hat size and do not converge one by one)."""
    Ce, out = exact_compliance(fe), {}
    x = fe.x
    hz = np.sqrt(np.maximum(1 - x * x, 0))
    for n, (d, e) in dict(xx=(0, 0), xz=(0, 1), zx=(1, 0), zz=(1, 1)).items():
        for m, f in (("even", hz), ("odd", x * hz)):
            u, v = C[d, e] @ f, Ce[d, e] @ f
            dif, v = u - v - (u - v).mean(), v - v.mean()
            out[n + "_" + m] = float(np.abs(dif).max() / np.ptp(v))
    return out


def verify_sliding(fe, C):
    """full sliding (coupled, q = mu p everywhere) against the closed form"""
    eps = np.arctan(MU * (1 - 2 * NUS) / (2 * (1 - NUS))) / np.pi
    c = Contact(fe.x, fe.wt, fe.gap, C, MU, True)
    # direct: p>=0 with q = mu p
    con = np.abs(fe.x) < 1.05
    for _ in range(100):
        A = np.nonzero(con)[0]
        n = len(A)
        K = np.zeros((n + 1, n + 1))
        f = np.zeros(n + 1)
        K[:n, :n] = c.Czz[np.ix_(A, A)] + MU * c.Czx[np.ix_(A, A)]
        K[:n, n] = -1
        K[n, :n] = c.wt[A]
        f[:n] = -c.gap[A]
        f[n] = P_TOT
        y = np.linalg.solve(K, f)
        p = np.zeros(len(con))
        p[A] = y[:n]
        w = (c.Czz + MU * c.Czx) @ p - y[n] + c.gap
        new = (con & (p >= 0)) | (~con & (w < 0))
        if (new == con).all():
            break
        con = new
    c.p, c.q, c.con, c.st = p, MU * p, con, np.where(con, 1, 0)
    c.st[np.argmin(np.abs(fe.x))] = 0  # (only so that edges() has a 'stick' node)
    e = c.edges(0.5, eps)
    a = np.sqrt(P_TOT * R * (1 - NUS**2) / (ES * np.pi * (0.25 - eps**2)))
    xm = (fe.wt @ (p * fe.x)) / P_TOT
    # p = E* cos(pi eps)/(2R) (a+xi)^(1/2-eps) (a-xi)^(1/2+eps), centre of the contact at -2 eps a;
    # P = (E*/R) pi a^2 (1/4-eps^2); mean of xi by the beta function
    m_xi = -2 * eps * a / 3
    return dict(
        eps=float(eps),
        a=[0.5 * (e["aR"] - e["aL"]), float(a)],
        centre=[0.5 * (e["aR"] + e["aL"]), float(-2 * eps * a)],
        x_mean=[float(xm), float(m_xi - 2 * eps * a)],
    )


# ----------------------------------------------------------------------------- driver
def summarise(lv, dom, inc):
    """lv: results at three meshes (coarse..fine); dom: (L, 2.5L) pair at one mesh; inc: (n, 2n) pair.
    value: Aitken extrapolation over the meshes where the differences shrink, else the finest;
    error: max(|fine-mid|, |extrapolation-fine|) + |domain| + |increments|."""
    out = {}
    for ph in ("press", "shear"):
        out[ph] = {}
        for k, v in lv[-1][ph].items():
            if isinstance(v, bool):
                out[ph][k] = v
                continue
            f1, f2, f3 = (r[ph][k] for r in lv)
            d1, d2 = f2 - f1, f3 - f2
            r = d2 / d1 if d1 != 0 else 0
            ext = f3 + d2 * r / (1 - r) if 0 < r < 0.6 else f3
            eL = abs(dom[1][ph][k] - dom[0][ph][k])
            en = abs(inc[1][ph][k] - inc[0][ph][k])
            out[ph][k] = dict(
                value=ext, err=max(abs(d2), abs(ext - f3)) + eL + en, meshes=[f1, f2, f3], d_domain=eL, d_increments=en
            )
    # profiles: largest difference fine - mid on the vertices of the mid mesh, off the singular points
    a2, a3 = lv[-2], lv[-1]
    for ph in ("press", "shear"):
        p0 = a3[ph]["p0"]
        e = [a3[ph][k] for k in ("aL", "aR", "cL", "cR")]
        for k in a3[ph + "_prof"]:
            if k == "x" or "jump" in k:
                continue
            x = a2[ph + "_prof"]["x"]
            d = np.abs(np.interp(x, a3[ph + "_prof"]["x"], a3[ph + "_prof"][k]) - a2[ph + "_prof"][k])
            if k.startswith("surf"):
                d = d[np.min(np.abs(x[:, None] - np.array(e)), axis=1) > 0.05]
            out[ph][k + "_maxdiff/p0"] = float(d.max() / p0)
        x = a2["surf"]["x"]
        ok = np.min(np.abs(x[:, None] - np.array(e)), axis=1) > 0.05
        for k in ("p_", "q_"):
            d = np.abs(np.interp(x, a3["surf"]["x"], a3["surf"][k + ph]) - a2["surf"][k + ph])
            out[ph][k + "maxdiff/p0 (0.05 off the edges)"] = float(d[ok].max() / p0)
    return out


def clean(o):
    if isinstance(o, dict):
        return {str(k): clean(v) for k, v in o.items()}
    if isinstance(o, (list, tuple)):
        return [clean(v) for v in o]
    if isinstance(o, np.ndarray):
        return [float(f"{v:.9g}") for v in o]
    if isinstance(o, (bool, np.bool_)):
        return bool(o)
    if isinstance(o, (np.integer, int)):
        return int(o)
    if isinstance(o, (np.floating, float)):
        return float(f"{o:.9g}")
    return o


def make(cs, level, L):
    k = CASES[cs]
    fe = FE(k["E"], k["nu"], k["t"], k["W"], level, L)
    C = fe.compliance()
    print(
        f"case {cs} level {level} h={fe.h:g} L={fe.Lx:.0f}: {fe.N} dofs, {fe.M} contact nodes, factor {fe.tfac:.0f} s, "
        f"compliance {fe.tcomp:.0f} s",
        flush=True,
    )
    return fe, C


def main(cases="ABH", levels=(1, 2, 3), L=200.0, n=200, out="coated.json"):
    tic = time.time()
    J = dict(parameters=dict(R=R, mu=MU, E_s=ES, nu_s=NUS, P=P_TOT, Q_end=QRATIO * MU * P_TOT, cases=CASES, conventions=__doc__))
    for cs in cases:
        t0 = time.time()
        D = {}
        lv = []
        lvu = []
        for level in levels:
            fe, C = make(cs, level, L)
            lv.append(run_load(fe, C, n, n))
            lvu.append(run_load(fe, C, 2, n, coupled=False))
            if cs == "H":
                D[f"verify_uncoupled_h={fe.h:g}"] = verify_uncoupled(lvu[-1])
                D[f"verify_compliance_relerr_h={fe.h:g}"] = verify_compliance(fe, C)
                D[f"verify_sliding_h={fe.h:g} [FE, exact]"] = verify_sliding(fe, C)
            if level == levels[1]:
                inc = [lv[-1]] + [run_load(fe, C, m, m, fe_post=False) for m in (2 * n, 4 * n)]
                D["increments"] = {str(r["meta"]["n_press"]): {p: r[p] for p in ("press", "shear")} for r in inc}
            fe.sol.free()
        fe, C = make(cs, levels[1], 2.5 * L)
        dom = [lv[1], run_load(fe, C, n, n)]
        domu = [lvu[1], run_load(fe, C, 2, n, coupled=False)]
        D["domains"] = {"{:.0f}".format(r["meta"]["L"]): {p: r[p] for p in ("press", "shear")} for r in dom}
        fe.sol.free()
        D["summary_coupled"] = summarise(lv, dom, inc[:2])
        D["summary_uncoupled"] = summarise(lvu, domu, [lvu[1]] * 2)
        D["coupled"] = {"h={:g}".format(r["meta"]["h"]): r for r in lv}
        D["uncoupled"] = {"h={:g}".format(r["meta"]["h"]): r for r in lvu}
        D["seconds"] = time.time() - t0
        J[cs] = D
        J["total_seconds"] = time.time() - tic
        with open(out, "w") as f:
            json.dump(clean(J), f)
        print("case {} done: {:.0f} s".format(cs, D["seconds"]), flush=True)
    return J


if __name__ == "__main__":
    # Intervals of level l: 0.04/2^l.
    cs = sys.argv[1] if len(sys.argv) > 1 else "ABH"
    f = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    main(cs, (f - 2, f - 1, f), out="coated.json" if f == 3 and cs == "ABH" else f"coated_{cs}{f}.json")
