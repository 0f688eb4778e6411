# mypy: disable-error-code="empty-body"
"""Closed forms, evaluated by the library, NaN outside their domain. Arguments may be arrays; they are broadcast.

Forces are per unit thickness. `half_width` is that of the contact. `beta` is Dundurs' parameter
(kappa - 1)/(kappa + 1). The sources are in docs/theory.md.
"""

from __future__ import annotations

import functools
import inspect
from ctypes import byref, c_double
from typing import Any, Callable, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import library, text_for

#: A number, or an array of them.
Number = ArrayLike
Array = NDArray[np.float64]

_Function = TypeVar("_Function", bound=Callable[..., Array])


def _closed_form(declared: _Function) -> _Function:
    """Evaluate the library's closed form of the same name over arrays; a plain number for plain numbers."""
    signature = inspect.signature(declared)
    name, count = text_for(declared.__name__), len(signature.parameters)

    def value_of(*numbers: float) -> float:
        value = c_double()
        library().mfv_reference(name, count, (c_double * count)(*numbers), byref(value))
        return value.value

    @functools.wraps(declared)
    def evaluated(*arguments: Number, **named: Number) -> Any:
        return np.vectorize(value_of, otypes=[np.float64])(*signature.bind(*arguments, **named).args)[()]

    return cast(_Function, evaluated)


@_closed_form
def hertz_half_width(normal_force: Number, radius: Number, shear_modulus: Number, kolosov_constant: Number) -> Array:
    """Half-width of the contact of a rigid cylinder with a half-plane (Hertz)."""


@_closed_form
def hertz_pressure(x: Number, normal_force: Number, half_width: Number) -> Array:
    """Pressure at x under a cylinder (Hertz)."""


@_closed_form
def flat_punch_pressure(x: Number, normal_force: Number, half_width: Number) -> Array:
    """Pressure at x under a rigid flat punch without friction."""


@_closed_form
def spence_stick_ratio(friction_coefficient: Number, beta: Number) -> Array:
    """Ratio of the widths of stick zone and contact under a growing normal force (Spence)."""


@_closed_form
def spence_cylinder_shear(x: Number, normal_force: Number, half_width: Number, friction_coefficient: Number, beta: Number) -> Array:
    """Shear traction at x under a cylinder pressed with friction, Goodman's coupling (Spence)."""


@_closed_form
def spence_flat_punch_shear(
    x: Number, normal_force: Number, half_width: Number, friction_coefficient: Number, beta: Number
) -> Array:
    """Shear traction at x under a flat punch pressed with friction, Goodman's coupling (Spence)."""


@_closed_form
def mindlin_stick_ratio(tangential_force: Number, normal_force: Number, friction_coefficient: Number) -> Array:
    """Ratio of the widths of stick zone and contact of a cylinder pressed, then sheared (Cattaneo, Mindlin)."""


@_closed_form
def mindlin_shear(
    x: Number, tangential_force: Number, normal_force: Number, half_width: Number, friction_coefficient: Number
) -> Array:
    """Shear traction at x under a cylinder pressed, then sheared by a growing force (Cattaneo, Mindlin)."""


@_closed_form
def mindlin_dissipation(
    tangential_force: Number, normal_force: Number, half_width: Number, radius: Number, friction_coefficient: Number
) -> Array:
    """Energy that a cylinder dissipates in a cycle of shear between +Q and -Q, per unit thickness (Mindlin)."""


@_closed_form
def carter_creepage(
    tangential_force: Number, normal_force: Number, half_width: Number, radius: Number, friction_coefficient: Number
) -> Array:
    """Sliding per rolled distance of two similar cylinders in steady rolling to the right (Carter).

    1/radius = 1/R1 + 1/R2. Rolling to the left the creepage has the other sign.
    """


@_closed_form
def carter_shear(
    x: Number, tangential_force: Number, normal_force: Number, half_width: Number, friction_coefficient: Number
) -> Array:
    """Shear traction at x, from the middle of the contact, of similar cylinders that roll to the right (Carter)."""


def wedge_half_width(normal_force: Number, slope: Number, shear_modulus: Number, kolosov_constant: Number) -> Array:
    """Half-width of the contact of a rigid wedge with a half-plane; `slope`: tangent of the angle of a flank to the surface."""
    return power_half_width(normal_force, slope, 1.0, shear_modulus, kolosov_constant)


def wedge_pressure(x: Number, normal_force: Number, half_width: Number) -> Array:
    """Pressure at x under a wedge, large at its tip."""
    return power_pressure(x, normal_force, half_width, 1.0)


def wedge_stick_ratio(tangential_force: Number, normal_force: Number, friction_coefficient: Number) -> Array:
    """Ratio of the widths of stick zone and contact of a wedge pressed, then sheared: 1 - Q/(mu P)."""
    return power_stick_ratio(tangential_force, normal_force, friction_coefficient, 1.0)


def wedge_shear(
    x: Number, tangential_force: Number, normal_force: Number, half_width: Number, friction_coefficient: Number
) -> Array:
    """Shear traction at x under a wedge pressed, then sheared by a growing force."""
    return power_shear(x, tangential_force, normal_force, half_width, friction_coefficient, 1.0)


@_closed_form
def power_half_width(
    normal_force: Number, coefficient: Number, exponent: Number, shear_modulus: Number, kolosov_constant: Number
) -> Array:
    """Half-width of the contact of a rigid body of the shape coefficient |x|^exponent with a half-plane."""


@_closed_form
def power_approach(half_width: Number, coefficient: Number, exponent: Number, datum: Number) -> Array:
    """Approach of such a body to a half-plane's surface point at the distance `datum`."""


@_closed_form
def power_pressure(x: Number, normal_force: Number, half_width: Number, exponent: Number) -> Array:
    """Pressure at x under such a body."""


@_closed_form
def power_stick_ratio(tangential_force: Number, normal_force: Number, friction_coefficient: Number, exponent: Number) -> Array:
    """Ratio of the widths of stick zone and contact of such a body pressed, then sheared (Jaeger, Ciavarella)."""


@_closed_form
def power_shear(
    x: Number,
    tangential_force: Number,
    normal_force: Number,
    half_width: Number,
    friction_coefficient: Number,
    exponent: Number,
) -> Array:
    """Shear traction at x under such a body pressed, then sheared by a growing force (Jaeger, Ciavarella)."""


@_closed_form
def rounded_punch_half_width(
    normal_force: Number, flat_half_width: Number, edge_radius: Number, shear_modulus: Number, kolosov_constant: Number
) -> Array:
    """Half-width of the contact of a rigid flat punch with rounded edges with a half-plane (Ciavarella, Hills and Monno)."""


@_closed_form
def rounded_punch_approach(half_width: Number, flat_half_width: Number, edge_radius: Number, datum: Number) -> Array:
    """Approach of such a punch to a half-plane's surface point at the distance `datum`."""


@_closed_form
def rounded_punch_pressure(x: Number, normal_force: Number, half_width: Number, flat_half_width: Number) -> Array:
    """Pressure at x under such a punch."""


@_closed_form
def rounded_punch_stick_ratio(
    tangential_force: Number,
    normal_force: Number,
    friction_coefficient: Number,
    half_width: Number,
    flat_half_width: Number,
) -> Array:
    """Ratio of the widths of stick zone and contact of such a punch pressed, then sheared (Jaeger, Ciavarella)."""


@_closed_form
def rounded_punch_shear(
    x: Number,
    tangential_force: Number,
    normal_force: Number,
    half_width: Number,
    friction_coefficient: Number,
    flat_half_width: Number,
) -> Array:
    """Shear traction at x under such a punch pressed, then sheared by a growing force (Jaeger, Ciavarella)."""


@_closed_form
def persson_force(half_angle: Number, clearance: Number, youngs_modulus: Number, poisson_ratio: Number) -> Array:
    """Force at which the contact of a pin in a bore reaches `half_angle` (radians) to either side (Persson).

    Both of one material in plane strain, without friction. `clearance`: by how much the bore's radius is larger.
    """


@_closed_form
def yield_contact_arc(youngs_modulus: Number, poisson_ratio: Number, yield_strength: Number) -> Array:
    """Contact arc 2a/R (radians) at which a cylinder pressed on a rigid plane without friction yields, plane strain."""


@_closed_form
def surface_compliance(s11: Number, s12: Number, s22: Number, s16: Number, s26: Number, s66: Number, number: Number) -> Array:
    """A constant of an anisotropic half-plane below its surface [length^2/force], from its reduced compliances along x and y.

    `number` 1: A (normal displacement by pressure), 2: At (tangential by shear), 3: M (between them), 4: B (coupling). Forms that take
    `shear_modulus` and `kolosov_constant` hold for such a body under pressure with 1/A and 3.
    """


@_closed_form
def oblique_half_width(
    normal_force: Number, tangential_force: Number, radius: Number, modulus: Number, mixed_ratio: Number
) -> Array:
    """Half-width of the contact of two half-planes of one anisotropic material in one direction, one with a gap x^2/(2 radius).

    `modulus`: 1/A, `mixed_ratio`: M/A of both bodies together.
    """


@_closed_form
def oblique_stick_ratio(tangential_force: Number, normal_force: Number, friction_coefficient: Number, mixed_ratio: Number) -> Array:
    """Width of the stick zone over that of the contact of such bodies, pressed without shear, then sheared by a growing force."""


@_closed_form
def wave_half_width(
    normal_force: Number, amplitude: Number, wavelength: Number, shear_modulus: Number, kolosov_constant: Number
) -> Array:
    """Half-width of the contact of a rigid wave amplitude (1 - cos(2 pi x/wavelength)) with a half-plane that repeats (Westergaard).

    Forces are those of one wave; half the wavelength in full contact.
    """


@_closed_form
def wave_pressure(
    x: Number, normal_force: Number, amplitude: Number, wavelength: Number, shear_modulus: Number, kolosov_constant: Number
) -> Array:
    """Pressure at x under such a wave (Westergaard), also in full contact."""


@_closed_form
def wave_stick_ratio(
    tangential_force: Number,
    normal_force: Number,
    friction_coefficient: Number,
    amplitude: Number,
    wavelength: Number,
    shear_modulus: Number,
    kolosov_constant: Number,
) -> Array:
    """Width of the stick zone over that of the contact of such a wave, pressed, then sheared; NaN in full contact."""
