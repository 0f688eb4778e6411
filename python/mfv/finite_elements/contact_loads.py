"""Loads of a contact over time from a finite-element result, and what a scene takes of them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .._files import written
from ..scene import History, Step
from .bulk import Bulk, bulk_stress
from .edge_fits import Edge, contact_nodes, edge
from .readers import Name, Source, read_surface
from .record import Array, Columns, Places
from .traces import Axes, Traces, traces_of

#: Nodes for the bulk stress are at distances from the contact between these multiples of its half-width.
BESIDE = (0.5, 3.0)


@dataclass(frozen=True)
class ContactLoads:
    """Loads over time in MFV's conventions, per unit thickness; arrays (times,). Lengths, forces and stresses as in the model, times its scales."""

    source: str
    #: Times of the model.
    t: Array
    #: Normal force [force/length], positive in compression.
    P: Array
    #: Tangential force on the lower body to the right [force/length].
    Q: Array
    #: Moment on the upper body about (centre, 0), counterclockwise [force].
    M: Array
    #: x of the origin of the scene along the contact in the model [length].
    centre: float
    #: Edges; their x counts from the centre.
    left: Edge
    right: Edge
    #: None if the result has no stresses beside the contact of this body.
    lower_bulk: Bulk | None = None
    upper_bulk: Bulk | None = None
    notes: list[str] = field(default_factory=list)

    @property
    def loaded(self) -> slice:
        """The times from the first contact on, which a history has."""
        return slice(int(np.argmax(self.P > 0.0)), None)

    def table(self, *, moment: bool = False, edge: str | None = None) -> dict[str, Array]:
        """The columns of `&history` and time, from the first contact on. `moment`: for bodies that could tilt, such as punches.

        `edge`: 'left' or 'right', for that edge by itself (`Body.edge`) K_N and K_T in place of the forces; the left edge becomes the right
        one of the mirror image. Raises ValueError if they are unknown at a time.
        """
        columns = {"time": self.t, "normal_force": self.P, "tangential_force": self.Q}
        if edge is not None:
            columns = {"time": self.t, **self._intensities(edge)}
        elif moment:
            columns["moment"] = self.M
        for name, bulk in (("lower_bulk_stress", self.lower_bulk), ("upper_bulk_stress", self.upper_bulk)):
            if bulk is not None:
                columns[name] = bulk.stress
        return {name: values[self.loaded] for name, values in columns.items()}

    def edges(self) -> dict[str, Array]:
        """Edges, K_N and K_T with their errors, and the errors of the bulk stresses, at all times, by names of columns."""
        columns = {"time": self.t}
        for side, values in (("left", self.left), ("right", self.right)):
            columns |= {f"{side}_{name}": column for name, column in values._asdict().items()}
        return columns | {f"{name}_error": errors for name, errors in self._errors().items()}

    def _errors(self, edge: str | None = None) -> dict[str, Array]:
        """Errors of the columns of `table` that have them."""
        at = {"left": self.left, "right": self.right}.get(edge or "")
        errors = {} if at is None else {"normal_intensity": at.K_N_error, "shear_intensity": at.K_T_error}
        bulks = {"lower_bulk_stress": self.lower_bulk, "upper_bulk_stress": self.upper_bulk}
        return errors | {name: bulk.error for name, bulk in bulks.items() if bulk is not None}

    def history(
        self,
        *,
        moment: bool = False,
        edge: str | None = None,
        period: int | None = None,
        cycles: int | None = None,
        steady_tolerance: float | None = None,
    ) -> History:
        """The loads as a `History` of a scene; `moment`, `edge`: as in `table`. Raises ValueError if there is no contact, and as `table`."""
        self._check_contact()
        return History.from_table(
            self.table(moment=moment, edge=edge), period=period, cycles=cycles, steady_tolerance=steady_tolerance
        )

    def steps(self, *, moment: bool = False, edge: str | None = None) -> list[Step]:
        """A `Step` for every time, with friction; otherwise as `history`."""
        self._check_contact()
        columns = {name: values for name, values in self.table(moment=moment, edge=edge).items() if name != "time"}
        targets: list[Any] = [{name: float(value) for name, value in zip(columns, row)} for row in zip(*columns.values())]
        return [Step(**target) for target in targets]

    def write(self, path: str | os.PathLike[str], *, moment: bool = False, edge: str | None = None) -> None:
        """Write the table as a text that `&history file='...'` reads, with largest errors and notes as comments. Raises OSError; otherwise
        as `history`."""
        self._check_contact()
        heading = [f"{self.source}: loads per unit thickness, x = 0 at {self.centre:.9g} along the surface"]
        heading += [f"error of {name}: at most {np.max(errors[self.loaded]):.2g}" for name, errors in self._errors(edge).items()]
        _write(Path(path), "\n".join(f"# {line}" for line in [*heading, *self.notes]), self.table(moment=moment, edge=edge))

    def write_edges(self, path: str | os.PathLike[str]) -> None:
        """Write the edges with K_N, K_T and their errors as a text with a comma between columns. Raises OSError."""
        _write(Path(path), f"# {self.source}: edges; x from {self.centre:.9g} along the surface", self.edges())

    def _intensities(self, side: str) -> dict[str, Array]:
        """K_N and K_T of an edge, as that on the right."""
        if side not in ("left", "right"):
            raise ValueError(f"edge: must be 'left' or 'right', not {side!r}")
        at = self.left if side == "left" else self.right
        unknown = np.nonzero(~np.isfinite(at.K_N + at.K_T)[self.loaded])[0]
        if len(unknown):
            raise ValueError(f"{self.source}: K_N or K_T of the {side} edge is unknown at time {self.t[self.loaded][unknown[0]]:g}")
        return {"normal_intensity": at.K_N, "shear_intensity": at.K_T if side == "right" else -at.K_T}

    def _check_contact(self) -> None:
        if not np.any(self.P > 0.0):
            raise ValueError(f"{self.source}: the bodies do not touch at any time")


def from_fe(
    source: Source,
    surface: str | None = None,
    *,
    opposite: str | None = None,
    mesh: Name | None = None,
    columns: Columns | None = None,
    times: Sequence[float] | None = None,
    body: str | None = None,
    angle: float = 0.0,
    centre: float | None = None,
    thickness: float | None = None,
    quadratic: bool = False,
    sign: float = 1.0,
    shear_sign: float = 1.0,
    bulk_range: tuple[float, float] = BESIDE,
    length_scale: float = 1.0,
    force_scale: float = 1.0,
) -> ContactLoads:
    """Loads, edges and bulk stresses from nodal forces or tractions on a surface of a plane finite-element model.

    `source`: a file of one of the formats of `readers.FORMATS`, files with a time each, or a mapping of arrays x and y (nodes), t (times), and
    values (times, nodes): force_x and force_y [force], or pressure and shear [force/length^2], and stress_xx, stress_yy, stress_xy.
    `surface`: its node set, surface or array. `opposite`: that of the other body, for its bulk stress. `mesh`: the input deck of a result
    without sets or positions. `columns`: names in the result by these names. `times`: of files with one time each.

    Conventions: the model is in its x-y plane; `angle` is that of the contact's x axis in it, in degrees counterclockwise, and the
    lower body is below the contact. `body`: 'lower' or 'upper', that of the surface; if omitted, by the mesh, else by the forces. Forces act on
    that body; `sign=-1`: it exerts them. Pressure is positive in compression, and shear acts on the lower body along the contact's
    x axis; `shear_sign=-1`: against it. If a result has both, forces are used unless they are 0. Forces and moments are divided by
    `thickness`, if omitted that of a three-dimensional mesh, else 1. `centre`: the origin of the scene, along the contact
    [length of the model]; if omitted the middle of the contact when P is largest. `quadratic`: of surfaces without a mesh, every second node
    is between corners. `bulk_range`: distances from the contact, in half-widths, between which stresses are used. Scales are units
    of the scene per unit of the model.

    Raises OSError, ValueError, InputError for columns, ModuleNotFoundError for a missing package.
    """
    _check(body, sign, shear_sign, thickness, bulk_range, length_scale, force_scale)
    axes = Axes(angle, body, thickness, sign, shear_sign)
    record = read_surface(source, surface, mesh, columns, times)
    if set(record.fields) <= {"stress_xx", "stress_yy", "stress_xy"}:
        raise ValueError(f"{record.source}: has stresses only; nodal forces or tractions of the contact are needed on this surface")
    traces = _scaled(traces_of(record, axes, quadratic), length_scale, force_scale)
    other = None
    if opposite is not None:
        of_other = axes._replace(body="upper" if traces.body == "lower" else "lower")
        beside = read_surface(source, opposite, mesh, columns, times)
        stresses = {key: values for key, values in beside.fields.items() if key.startswith("stress")}
        if not stresses:
            raise ValueError(
                f"{beside.source}: has no stresses (stress_xx, stress_yy, stress_xy), which the opposite surface is for"
            )
        if not np.array_equal(beside.times, record.times):
            raise ValueError(f"{beside.source}: has other times than {record.source}; is the result complete?")
        other = _scaled(traces_of(beside._replace(fields=stresses), of_other), length_scale, force_scale)
    return _loads(traces, other, None if centre is None else centre * length_scale, bulk_range)


def _check(
    body: str | None,
    sign: float,
    shear_sign: float,
    thickness: float | None,
    bulk_range: tuple[float, float],
    length_scale: float,
    force_scale: float,
) -> None:
    """Raises ValueError for an invalid option."""
    if body not in (None, "lower", "upper"):
        raise ValueError(f"body: must be 'lower' or 'upper', not {body!r}")
    for name, value in (("sign", sign), ("shear_sign", shear_sign)):
        if value not in (1.0, -1.0):
            raise ValueError(f"{name}: must be 1 or -1, not {value!r}")
    scales = {"thickness": 1.0 if thickness is None else thickness, "length_scale": length_scale, "force_scale": force_scale}
    for name, value in scales.items():
        if not 0.0 < value < np.inf:
            raise ValueError(f"{name}: must be positive, not {value!r}")
    if not 0.0 <= bulk_range[0] < bulk_range[1]:
        raise ValueError(f"bulk_range: must be two increasing numbers of half-widths, not {bulk_range!r}")


def _scaled(traces: Traces, length: float, force: float) -> Traces:
    """Traces in the units of the scene."""
    per_length, per_area, stress, tractions = force / length, force / length**2, traces.stress, traces.tractions
    return traces._replace(
        x=length * traces.x,
        y=length * traces.y,
        width=length * traces.width,
        normal=per_length * traces.normal,
        shear=per_length * traces.shear,
        stress_x=length * traces.stress_x,
        stress=None if stress is None else per_area * stress,
        tractions=None if tractions is None else (per_area * tractions[0], per_area * tractions[1]),
        totals=None if traces.totals is None else traces.totals * [per_length, per_length, force],
    )


def _loads(traces: Traces, other: Traces | None, centre: float | None, reach: tuple[float, float]) -> ContactLoads:
    """The loads. Raises ValueError if there is no contact or the bodies pull at one another."""
    P, Q = (traces.normal.sum(axis=1), traces.shear.sum(axis=1)) if traces.totals is None else traces.totals.T[:2]
    fullest = int(np.argmax(P))
    if not P[fullest] > 0.0:
        raise ValueError(
            f"{traces.source}: no compression at any time; are these the contact's forces or tractions? (CalculiX has tractions at the slave "
            "surface only; pressures are positive; sign=-1 and body choose whose forces they are)"
        )
    pulled = int(np.argmin(P))
    if P[pulled] < -1e-6 * P[fullest]:
        raise ValueError(
            f"{traces.source}: the forces pull the bodies apart at time {traces.times[pulled]:g}; are these of the contact alone?"
        )
    pressure, shear = traces.tractions or (traces.normal / traces.width, traces.shear / traces.width)
    left, right = (edge(traces.x, traces.width, pressure, shear, traces.tractions is not None, side) for side in (-1, 1))
    loaded = contact_nodes(pressure[fullest])
    outermost = float(traces.x[loaded[0]]), float(traces.x[loaded[-1]])
    ends = tuple(float(each.x[fullest]) if np.isfinite(each.x[fullest]) else end for each, end in zip((left, right), outermost))
    origin = 0.5 * (ends[0] + ends[1]) if centre is None else centre
    touched = traces.x[np.unique(np.concatenate([contact_nodes(row) for row in pressure]))]
    extent = float(touched[0]), float(touched[-1])
    bodies: dict[str, Bulk | None] = {traces.body: bulk_stress(traces, traces, extent, reach)}
    if other is not None:
        bodies[other.body] = bulk_stress(other, traces, extent, reach)
    return ContactLoads(
        traces.source,
        traces.times,
        np.where(np.abs(P) < 1e-12 * P[fullest], 0.0, P),
        Q,
        _moment(traces, P, Q, origin, float(traces.y[loaded].mean())),
        origin,
        left._replace(x=left.x - origin),
        right._replace(x=right.x - origin),
        bodies.get("lower"),
        bodies.get("upper"),
        _notes(traces, other, bodies, loaded, left, right, fullest),
    )


def _moment(traces: Traces, P: Array, Q: Array, x: float, y: float) -> Array:
    """M about the point (x, y) of the contact: that of the forces on the lower body, which balances the load on the upper one."""
    if traces.totals is None:
        return -traces.normal @ (traces.x - x)
    return np.asarray(traces.totals[:, 2] + x * P + y * Q)


def _notes(
    traces: Traces, other: Traces | None, bodies: dict[str, Bulk | None], loaded: Places, left: Edge, right: Edge, fullest: int
) -> list[str]:
    """What a user should know."""
    notes = []
    if traces.tractions is not None and traces.totals is None:
        notes.append(
            f"P and Q are integrals of tractions between nodes; P where it is largest is known to about {_uncertainty(traces, fullest):.1%}, Q "
            "less well if the edges stick; nodal forces (columns force_x, force_y) give exact sums"
        )
    if loaded[0] == 0 or loaded[-1] == len(traces.x) - 1:
        notes.append(
            "the contact reaches the end of the node set: a complete contact, or the set is too short; K_N and K_T are unknown there"
        )
    elif not np.isfinite(left.K_N[fullest] + right.K_N[fullest]):
        notes.append(
            f"K_N and K_T are not resolved by the {len(loaded)} nodes in contact where P is largest, or the tractions scatter"
        )
    if len(loaded) and not np.all(np.diff(loaded) == 1):
        notes.append("the contact has gaps between nodes: edges are the outermost ones")
    for of_body in (traces, other):
        if of_body is not None and of_body.stress is not None and bodies.get(of_body.body) is None:
            notes.append(
                f"no bulk stress of the {of_body.body} body: fewer than 2 nodes with stresses lie beside the contact (bulk_range)"
            )
    if traces.stress is not None and other is None:
        without = "upper" if traces.body == "lower" else "lower"
        notes.append(f"no bulk stress of the {without} body, so none acts on it; name its surface by opposite (--opposite)")
    return notes


def _uncertainty(traces: Traces, at: int) -> float:
    """The difference of P by every second node from that by all, relative; halving elements reduces the error at edges by 2^1.5."""
    assert traces.tractions is not None
    pressure = traces.tractions[0][at]
    sums = [float(np.sum(np.diff(x) * (p[1:] + p[:-1]))) for x, p in ((traces.x, pressure), (traces.x[::2], pressure[::2]))]
    return float(abs(sums[1] / sums[0] - 1.0) / (2.0**1.5 - 1.0))


def _write(path: Path, heading: str, columns: dict[str, Array]) -> None:
    """Write columns with their names under a comment. Raises OSError."""
    with written(path) as part, part.open("w", encoding="utf-8") as file:
        file.write(f"{heading}\n{','.join(columns)}\n")
        np.savetxt(file, np.column_stack(list(columns.values())), fmt="%.10g", delimiter=",")
