"""A surface in the axes of the contact: nodal forces of its tractions on the lower body, per unit thickness."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .record import Array, Face, Places, Record

#: Forces below this fraction of the largest pressure times the length of the surface are those of rounding: where bodies touch, some programs
#: have reactions that are 0.
NEGLIGIBLE = 1.0e-6

#: The outward normal of a surface may differ from that of the contact by this angle, in degrees.
ASKEW = 45.0


class Axes(NamedTuple):
    """How the contact lies in the model."""

    #: From the x axis of the model to that of the contact, in degrees, counterclockwise.
    angle: float
    #: The body of the surface, lower or upper; None: the one on which the nodal forces act.
    body: str | None
    #: Per model [length]; that of the mesh if None.
    thickness: float | None
    #: 1 or -1: forces on the body of the surface, or by it.
    sign: float
    #: 1 or -1: shear tractions act on the lower body along +x, or along -x.
    shear_sign: float


class Traces(NamedTuple):
    """Nodal forces along the contact, and the stress along the surface."""

    source: str
    body: str
    times: Array
    #: Of the corners of elements, increasing [length].
    x: Array
    #: Of the surface that belongs to each of them [length].
    width: Array
    #: Forces at these nodes, (times, nodes) [force/length]: pressing the bodies together, and on the lower body along +x.
    normal: Array
    shear: Array
    #: Pressure and shear traction at these nodes if the result has tractions, not forces, (times, nodes) [force/length^2].
    tractions: tuple[Array, Array] | None
    #: Of all nodes with stresses, and the stress along the surface there, (times, nodes) [force/length^2]; None without stresses.
    stress_x: Array
    stress: Array | None
    #: P, Q and the moment M about (0, 0) if the result has the resultants of the tractions, (times, 3); and y of the nodes [length].
    totals: Array | None
    y: Array


def traces_of(record: Record, axes: Axes, is_quadratic: bool = False) -> Traces:
    """A record in the axes of the contact. Raises ValueError.

    `is_quadratic`: every second node of a surface without a mesh is between the corners of an element.
    """
    turned, order, rotation = _turned(record, axes.angle)
    faces = _faces(record, turned, order, is_quadratic)
    thickness = record.thickness if axes.thickness is None else axes.thickness
    normal, shear, of_forces = _forces(record, axes, rotation, faces, turned[:, 0], thickness)
    body = _checked_body(record, axes, rotation, of_forces or _pressed(record, axes, rotation))
    totals = _resultants(record, axes, rotation, body, thickness)
    are_tractions = of_forces is None and "pressure" in record.fields
    sense = axes.shear_sign if totals is None else _sense(shear.sum(axis=1), totals[:, 1])
    if are_tractions:
        shear = sense * shear
    if totals is not None:
        normal, shear = _balanced(normal, shear, totals)
    corners, normal, shear, width = _at_corners(turned[:, 0], faces, normal, shear, order)
    return Traces(
        record.source,
        body,
        record.times,
        turned[corners, 0],
        width,
        normal,
        shear,
        (record.fields["pressure"][:, corners], sense * _shear_of(record)[:, corners]) if are_tractions else None,
        turned[order, 0],
        _stress_along(record, rotation)[:, order] if "stress_xx" in record.fields else None,
        totals,
        turned[corners, 1],
    )


def _pressed(record: Record, axes: Axes, rotation: tuple[float, float]) -> str | None:
    """The body that the resultants press; None without resultants."""
    if record.totals is None:
        return None
    up = axes.sign * (rotation[0] * record.totals[:, 1] - rotation[1] * record.totals[:, 0])
    return "lower" if up[np.argmax(np.abs(up))] < 0.0 else "upper"


def _resultants(record: Record, axes: Axes, rotation: tuple[float, float], body: str, thickness: float) -> Array | None:
    """P, Q and M about the origin of the model, (times, 3), from the resultants on the body of the surface."""
    if record.totals is None:
        return None
    across, along, moment = record.totals.T * axes.sign * (1.0 if body == "lower" else -1.0) / thickness
    cosine, sine = rotation
    return np.column_stack([sine * across - cosine * along, cosine * across + sine * along, moment])


def _sense(sums: Array, totals: Array) -> float:
    """1 or -1: whether sums of shear tractions have the sign of the resultants, which tell the direction of a program's tractions."""
    return 1.0 if float(sums @ totals) >= 0.0 else -1.0


def _balanced(normal: Array, shear: Array, totals: Array) -> tuple[Array, Array]:
    """Nodal forces whose sums are the resultants: the pressing ones in proportion, the difference of the others in proportion to these."""
    sums = normal.sum(axis=1)
    share = np.divide(normal, sums[:, None], out=np.zeros_like(normal), where=sums[:, None] > 0.0)
    return share * totals[:, :1], shear + share * (totals[:, 1] - shear.sum(axis=1))[:, None]


def _turned(record: Record, angle: float) -> tuple[Array, Places, tuple[float, float]]:
    """Positions in the axes of the contact, the order of the nodes along it, cosine and sine of the angle. Raises ValueError."""
    cosine, sine = _cosine(angle), _cosine(angle - 90.0)
    x, y = record.position.T
    turned = np.column_stack([cosine * x + sine * y, cosine * y - sine * x])
    order = np.argsort(turned[:, 0], kind="stable")
    along = turned[order, 0]
    if len(along) < 3:
        raise ValueError(f"{record.source}: has {len(along)} nodes; a contact needs at least 3")
    if np.any(np.diff(along) <= 1e-9 * np.ptp(record.position, axis=0).max()):
        raise ValueError(
            f"{record.source}: two nodes are at the same place along the contact; is angle={angle:g} the direction of the surface?"
        )
    return turned, order, (cosine, sine)


def _cosine(degrees: float) -> float:
    """A cosine that is exact at multiples of 90 degrees."""
    return float(np.round(np.cos(np.radians(degrees)), 15)) if degrees % 90.0 == 0.0 else float(np.cos(np.radians(degrees)))


def _faces(record: Record, turned: Array, order: Places, is_quadratic: bool) -> list[Face]:
    """The sides of elements along the surface, in their order; between neighbouring nodes if the mesh has none. Raises ValueError."""
    found = [
        face if turned[face.first, 0] < turned[face.last, 0] else face._replace(first=face.last, last=face.first)
        for face in record.faces
    ]
    covered = {node for face in found for node in face[:3] if node >= 0}
    if len(covered) == len(order):
        return sorted(found, key=lambda face: float(turned[face.first, 0]))
    nodes, nowhere = order.tolist(), (np.nan, np.nan)
    if not is_quadratic:
        return [Face(one, other, -1, nowhere) for one, other in zip(nodes, nodes[1:])]
    if len(nodes) % 2 == 0:
        raise ValueError(f"{record.source}: quadratic elements have an odd number of nodes along a surface, not {len(nodes)}")
    return [Face(nodes[at], nodes[at + 2], nodes[at + 1], nowhere) for at in range(0, len(nodes) - 2, 2)]


def _forces(
    record: Record, axes: Axes, rotation: tuple[float, float], faces: list[Face], x: Array, thickness: float
) -> tuple[Array, Array, str | None]:
    """Nodal forces pressing, and on the lower body along +x, (times, nodes), and the body on which forces act, None if tractions do not
    tell. Raises ValueError."""
    fields, (cosine, sine) = record.fields, rotation
    pressure = fields.get("pressure")
    if "force_x" in fields:
        across, along = fields["force_x"], fields["force_y"]
        largest = max(float(np.max(np.abs(across))), float(np.max(np.abs(along))))
        if pressure is None or largest > NEGLIGIBLE * float(np.max(np.abs(pressure))) * float(np.ptp(x)) * thickness:
            factor = axes.sign / thickness
            right, up = factor * (cosine * across + sine * along), factor * (cosine * along - sine * across)
            sums = up.sum(axis=1)
            body = "lower" if sums[np.argmax(np.abs(sums))] < 0.0 else "upper"
            is_lower = (axes.body or body) == "lower"
            return (-up, right, body) if is_lower else (up, -right, body)
    if pressure is None:
        zero = np.zeros((len(record.times), len(x)))
        return zero, zero, None
    return _consistent(faces, x, pressure), _consistent(faces, x, _shear_of(record)), None


def _shear_of(record: Record) -> Array:
    """The shear tractions of a record with pressures; 0 if it has none."""
    return record.fields.get("shear", np.zeros_like(record.fields["pressure"]))


def _consistent(faces: list[Face], x: Array, traction: Array) -> Array:
    """Nodal forces of tractions that are interpolated between the nodes as the elements do, (times, nodes)."""
    forces = np.zeros_like(traction)
    for face in faces:
        nodes = [face.first, face.last] if face.between < 0 else [face.first, face.between, face.last]
        forces[:, nodes] += traction[:, nodes] @ _mass(x[nodes])
    return forces


def _mass(x: Array) -> Array:
    """The integrals of products of the shape functions of a side with nodes at x."""
    points, weights = np.polynomial.legendre.leggauss(3)
    t, middle = 0.5 * (points + 1.0), (x[1] - x[0]) / (x[-1] - x[0])
    if len(x) == 2:
        shapes = np.array([1.0 - t, t])
    else:
        shapes = np.array(
            [(t - middle) * (t - 1.0) / middle, t * (t - 1.0) / (middle * (middle - 1.0)), t * (t - middle) / (1.0 - middle)]
        )
    return np.asarray(0.5 * (x[-1] - x[0]) * (shapes * weights) @ shapes.T)


def _checked_body(record: Record, axes: Axes, rotation: tuple[float, float], of_forces: str | None) -> str:
    """The body of the surface. Raises ValueError if it, forces and mesh contradict one another."""
    up = _outward(record, rotation)
    of_mesh = None if up is None else "lower" if up > 0.0 else "upper"
    body = axes.body or of_mesh or of_forces or "lower"
    if "stress_xx" in record.fields and not (axes.body or of_mesh or of_forces):
        raise ValueError(
            f"{record.source}: give body, 'lower' or 'upper': tractions do not tell whose surface and stresses these are"
        )
    if of_mesh is not None and body != of_mesh:
        raise ValueError(
            f"{record.source}: the surface faces {'up' if of_mesh == 'lower' else 'down'} at angle={axes.angle:g}, so it is that of the "
            f"{of_mesh} body, not the {body} one; correct body or angle (of the x axis of the contact in the model, degrees)"
        )
    if of_forces is not None and body != of_forces:
        raise ValueError(
            f"{record.source}: the nodal forces pull at the {body} body; with sign=-1 they are those that it exerts, or correct body or angle"
        )
    return body


def _outward(record: Record, rotation: tuple[float, float]) -> float | None:
    """The sine of the angle between the surface's outward normal, averaged, and the contact; None without a mesh. Raises ValueError."""
    if not record.faces:
        return None
    first = record.position[[face.first for face in record.faces]]
    last = record.position[[face.last for face in record.faces]]
    inside = np.array([face.inside for face in record.faces])
    along, out = last - first, 0.5 * (first + last) - inside
    normal = np.column_stack([along[:, 1], -along[:, 0]])
    normal *= np.sign(np.sum(normal * out, axis=1))[:, None]
    mean = normal.sum(axis=0) / np.sum(np.hypot(*along.T))
    cosine, sine = rotation
    right, up = cosine * mean[0] + sine * mean[1], cosine * mean[1] - sine * mean[0]
    if abs(right) > np.tan(np.radians(ASKEW)) * abs(up):
        direction = float(np.degrees(np.arctan2(mean[1], mean[0])))
        raise ValueError(
            f"{record.source}: the outward normal of the surface is at {direction:.1f} degrees from the x axis of the model, which is along "
            f"the contact: give angle={direction - 90.0:.1f} if the body is the lower one, {direction + 90.0:.1f} if it is the upper one"
        )
    return float(up)


def _at_corners(x: Array, faces: list[Face], normal: Array, shear: Array, order: Places) -> tuple[Places, Array, Array, Array]:
    """The corners in their order, forces at them, and widths. Forces between corners are divided between these, as by the lever rule, which
    is exact: hat functions between the corners are sums of the shape functions of a quadratic element."""
    normal, shear, width = normal.copy(), shear.copy(), np.zeros(len(x))
    between = set()
    for first, last, middle, _ in faces:
        length = x[last] - x[first]
        width[[first, last]] += 0.5 * length
        if middle >= 0:
            between.add(middle)
            share = (x[middle] - x[first]) / length
            for forces in (normal, shear):
                forces[:, first] += (1.0 - share) * forces[:, middle]
                forces[:, last] += share * forces[:, middle]
    corners = np.array([node for node in order if node not in between])
    return corners, normal[:, corners], shear[:, corners], width[corners]


def _stress_along(record: Record, rotation: tuple[float, float]) -> Array:
    """The normal stress along the axis x of the contact, (times, nodes)."""
    cosine, sine = rotation
    xx, yy, xy = (record.fields[key] for key in ("stress_xx", "stress_yy", "stress_xy"))
    return np.asarray(cosine**2 * xx + sine**2 * yy + 2.0 * cosine * sine * xy)
