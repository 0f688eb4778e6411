"""Stresses inside the bodies of a result, from its surface tractions, by the library's closed forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import real_pointer
from .case import case_of
from .inputs import keys
from .result import Result

#: The stresses at a point, in the order of the header: in Cartesian components, across the plane, principal ones in the
#: plane, von Mises, in polar components about the centre of a disk or hole, Tresca (sigma_zz counts), and the direction of the first
#: principal stress from the x axis, in radians.
NAMES = (
    "sigma_xx",
    "sigma_yy",
    "sigma_xy",
    "sigma_zz",
    "principal_1",
    "principal_2",
    "von_mises",
    "sigma_rr",
    "sigma_thetatheta",
    "sigma_rtheta",
    "tresca",
    "principal_angle",
)

#: The bodies, in the order of the header.
BODIES = ("lower", "upper")

Array = NDArray[np.float64]

#: Half the angle of contact, in radians, beyond which the grid is about the whole circle; its farthest distance around a hole, and the
#: nearest one to the centre of a disk, where the force that holds it acts, over the radius.
WIDE, BESIDE, NEAREST = 1.2, 2.5, 0.3


class Largest(NamedTuple):
    """The largest value of a stress and where it is."""

    value: float
    x: float
    y: float


@dataclass(frozen=True)
class StressField:
    """Stresses of one body at points or on a grid: `field["von_mises"]` has the shape of `field.x`."""

    body: str
    x: Array
    y: Array
    values: dict[str, Array]
    #: Half the length of the loaded surface, its middle, the largest pressure, the largest von Mises stress, the largest tension along
    #: the surface (NaN if they are unbounded, at a sharp corner; its place is NaN without tension). Places are NaN if the bulk stress is
    #: the largest.
    half_width: float
    middle: float
    largest_pressure: float
    largest: Largest
    tension: Largest

    def __getitem__(self, name: str) -> Array:
        return self.values[name]


def stress(result: Result, x: ArrayLike, y: ArrayLike, *, body: str = "lower", step: int | None = None) -> StressField:
    """Stresses at the points (x, y), lengths, y up from the contact; NaN outside the body.

    `body`: 'lower' or 'upper'. `step`: the state in `result.steps[step - 1]`, not the last one. `x` and `y` are broadcast.
    Raises ValueError for an unknown body or step and for a result from a file whose scene had arrays in memory, BadArgument for a body
    without stresses (rigid, or a matrix).
    """
    if body not in BODIES:
        raise ValueError(f"body must be 'lower' or 'upper', not '{body}'")
    across, up = (np.ascontiguousarray(values, dtype=np.float64) for values in np.broadcast_arrays(x, y))
    state = result.at(step)
    arc = _arc(result)
    none = np.full(arc.size, np.nan)
    edges = [state.get(name, none) for name in ("contact_edge", "stick_edge")]
    loads = [np.ascontiguousarray(values) for values in (arc, result.mesh.width, state.pressure, state.shear, *edges)]
    values, largest, tension = np.empty((across.size, len(NAMES))), np.empty(3), np.empty(3)
    with case_of(result) as case:
        case._call(
            "mfv_stress_under",
            BODIES.index(body),
            arc.size,
            *map(real_pointer, loads),
            _bulk_stress(result, body, step),
            across.size,
            *map(real_pointer, (across, up, values, largest, tension)),
        )
    left, right = _loaded_surface(result, step)
    return StressField(
        body,
        across,
        up,
        {name: values[:, column].reshape(across.shape) for column, name in enumerate(NAMES)},
        0.5 * (right - left),
        0.5 * (right + left),
        float(np.max(state.pressure)),
        Largest(*map(float, largest)),
        Largest(*map(float, tension)),
    )


def grid(
    result: Result,
    *,
    body: str = "lower",
    step: int | None = None,
    width: float = 2.0,
    depth: float = 2.0,
    across: int = 161,
    down: int = 81,
) -> StressField:
    """Stresses on a grid `width` contact half-widths to either side of the contact and `depth` below the surface, shape
    (down, across); where a pin touches its bore nearly all around, on circles about its axis, shape (down, 2 across - 1).

    Otherwise as `stress`. Raises ValueError without load.
    """
    left, right = _loaded_surface(result, step)
    half = 0.5 * (right - left)
    if half == 0.0:
        raise ValueError("no load in this state")
    if is_radial(result) and half > WIDE * _radius_of_nodes(result):
        radius, centre = float(result.scene[f"{body}_radius"]), _turning(result, body) * float(result.scene[f"{body}_radius"])
        is_disk = result.attributes[f"{body}_body"].endswith("disk")
        angle, distance = np.meshgrid(
            np.linspace(0.0, 2.0 * np.pi, 2 * across - 1),
            radius * np.linspace(1.0 - 1.0e-9, NEAREST, down) if is_disk else radius * np.geomspace(1.0 + 1.0e-9, BESIDE, down),
        )
        return stress(result, distance * np.sin(angle), centre - distance * np.cos(angle), body=body, step=step)
    x = 0.5 * (left + right) + half * np.linspace(-width, width, across)
    across_grid, below = np.meshgrid(x, half * np.linspace(0.0, depth, down))
    inside = surface(result, body, across_grid) - below
    return stress(result, across_grid, inside if body == "lower" else -inside, body=body, step=step)


def stored(result: Result, *, body: str = "lower", step: int | None = None) -> StressField | None:
    """The grid that mfv_stress has written into the file for this state and body, or None."""
    group = result.stresses.get(f"{'last' if step is None else f'{step:04d}'}/{body}")
    if group is None or "tresca" not in group:
        return None
    return StressField(
        body,
        np.broadcast_to(group.x, group.y.shape),
        group.y,
        {name: group[name] for name in NAMES},
        float(group.half_width),
        0.5 * float(group.x[0] + group.x[-1]),
        float(group.largest_pressure),
        Largest(float(group.largest_von_mises), float(group.largest_x), float(group.largest_y)),
        Largest(float(group.largest_tension), float(group.tension_x), float(group.tension_y)),
    )


def radius_of(result: Result, body: str) -> float | None:
    """Radius of the surface of a body that deforms as a disk or hole [length]; None for others, also disks and holes that deform as
    half-planes: with layers, or by their `elasticity`."""
    given = keys(result.attributes["input"]).get(f"body({BODIES.index(body) + 1})%elasticity", "own")
    is_half_plane = f"{body}_layers" in result.scene or str(given).lower() != "own"
    return None if is_half_plane else result.scene.get(f"{body}_radius")


def surface(result: Result, body: str, x: Array) -> Array:
    """Height of the undeformed surface of the lower body at x; of the upper one upside down. NaN beside a disk or hole; 0 for all that
    deforms as a half-plane."""
    radius = radius_of(result, body)
    if radius is None:
        return np.zeros_like(x)
    sign = -1.0 if result.attributes[f"{body}_body"].endswith("disk") else 1.0
    with np.errstate(invalid="ignore"):
        return np.asarray(sign * x**2 / (radius + np.sqrt(radius**2 - x**2)))


def slope(result: Result, body: str, x: ArrayLike) -> Array:
    """Angle of the undeformed surface of a body at x from the x axis, counterclockwise, in radians; NaN beside a disk or hole."""
    radius = radius_of(result, body)
    if radius is None:
        return np.zeros_like(x, dtype=np.float64)
    with np.errstate(invalid="ignore"):
        return np.asarray(_turning(result, body) * np.arcsin(np.asarray(x) / radius))


def beneath(result: Result, body: str, x: float, distance: Array, angle: ArrayLike = 0.0) -> tuple[Array, Array]:
    """Points x, y of a body at distances from the point of its surface at x, in directions from the inward normal there,
    counterclockwise, in radians."""
    turn = slope(result, body, x) + np.asarray(angle)
    side = 1.0 if body == "lower" else -1.0
    return x + side * distance * np.sin(turn), side * (surface(result, body, np.asarray(x)) - distance * np.cos(turn))


def surface_nodes(result: Result, body: str) -> tuple[Array, Array, Array]:
    """Positions x, y of the nodes on the undeformed surface of a body, and its slope there."""
    return _surface_at(result, body, _arc(result))


def contact_edges(result: Result, body: str, step: int | None = None) -> Array:
    """Positions x of the edges of contact on the undeformed surface of a body, increasing; empty without load. `step`: as in `stress`."""
    return _surface_at(result, body, _edges(result, step))[0]


def _surface_at(result: Result, body: str, arc: Array) -> tuple[Array, Array, Array]:
    """Positions x, y of points along the undeformed surface of a body, and its slope there."""
    radius = radius_of(result, body)
    if radius is None:
        return arc, np.zeros_like(arc), np.zeros_like(arc)
    angle = arc / (_radius_of_nodes(result) if is_radial(result) else radius)
    turning = _turning(result, body)
    return radius * np.sin(angle), 2.0 * turning * radius * np.sin(0.5 * angle) ** 2, turning * angle


def is_radial(result: Result) -> bool:
    """Whether normals are radial, so that places along the surface are angles."""
    return "arc" in result.mesh and bool(keys(result.attributes["input"]).get("mesh%normals", "vertical").lower() == "radial")


def drawn_at(result: Result, arc: Array | None = None) -> Array:
    """Where nodes, or arc lengths from the origin, are drawn: at their x; with radial normals at their angles, in degrees."""
    if is_radial(result):
        return np.degrees((_arc(result) if arc is None else arc) / _radius_of_nodes(result))
    return np.asarray(result.mesh.x if arc is None else arc)


def surface_at(result: Result, body: str, places: Array) -> tuple[Array, Array]:
    """Points x, y of the undeformed surface of a body at places as in `drawn_at`."""
    if is_radial(result):
        return _surface_at(result, body, np.radians(places) * _radius_of_nodes(result))[:2]
    return places, surface(result, body, places)


def _radius_of_nodes(result: Result) -> float:
    """With radial normals arc lengths are those of the hole, the larger of the circles."""
    return float(max(result.scene.lower_radius, result.scene.upper_radius))


def _turning(result: Result, body: str) -> float:
    """1 if the centre of a disk or hole is above its surface, where the slope increases with x, otherwise -1."""
    is_disk = result.attributes[f"{body}_body"].endswith("disk")
    return 1.0 if is_disk == (body == "upper") else -1.0


def _arc(result: Result) -> Array:
    """Positions of the nodes along the surface."""
    return np.ascontiguousarray(result.mesh.arc if "arc" in result.mesh else result.mesh.x)


def _bulk_stress(result: Result, body: str, step: int | None) -> float:
    """The bulk stress of a body, 0 in a result without."""
    loads = result.summary if step is None else result.steps[step - 1]
    return float(loads.get(f"{body}_bulk_stress", 0.0))


def _loaded_surface(result: Result, step: int | None) -> tuple[float, float]:
    """Ends of the loaded surface; both 0 without load."""
    edges = _edges(result, step)
    return (float(edges[0]), float(edges[-1])) if edges.size else (0.0, 0.0)


def _edges(result: Result, step: int | None) -> Array:
    """Positions along the surface of the edges of contact, increasing: interpolated ones if available, else the ends of the loaded
    surface; empty without load."""
    state = result.at(step)
    loaded = (state.pressure != 0.0) | (state.shear != 0.0)
    if not loaded.any():
        return np.empty(0)
    edges: Array = np.asarray(state.get("contact_edge", np.empty(0)))
    edges = np.unique(edges[np.isfinite(edges)])
    if edges.size > 1:
        return edges
    arc, half = _arc(result)[loaded], 0.5 * result.mesh.width[loaded]
    return np.array([np.min(arc - half), np.max(arc + half)])
