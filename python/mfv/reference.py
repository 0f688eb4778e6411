"""Closed forms, evaluated by the library, NaN outside their domain. Arguments may be arrays; they are broadcast.

Forces are per unit thickness. `half_width` is that of the contact. `beta` is Dundurs' parameter
(kappa - 1)/(kappa + 1). The sources are in docs/theory.md.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import library


def hertz_half_width(
    normal_force: ArrayLike, radius: ArrayLike, shear_modulus: ArrayLike, kolosov_constant: ArrayLike
) -> NDArray[np.float64]:
    """Half-width of the contact of a rigid cylinder with a half-plane (Hertz)."""
    return _evaluated("mfv_hertz_half_width", normal_force, radius, shear_modulus, kolosov_constant)


def hertz_pressure(x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike) -> NDArray[np.float64]:
    """Pressure at x under a cylinder (Hertz)."""
    return _evaluated("mfv_hertz_pressure", x, normal_force, half_width)


def flat_punch_pressure(x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike) -> NDArray[np.float64]:
    """Pressure at x under a rigid flat punch without friction."""
    return _evaluated("mfv_flat_punch_pressure", x, normal_force, half_width)


def spence_stick_ratio(friction_coefficient: ArrayLike, beta: ArrayLike) -> NDArray[np.float64]:
    """Width of the stuck zone over that of the contact under a growing normal force (Spence)."""
    return _evaluated("mfv_spence_stick_ratio", friction_coefficient, beta)


def spence_cylinder_shear(
    x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike, friction_coefficient: ArrayLike, beta: ArrayLike
) -> NDArray[np.float64]:
    """Shear traction at x under a cylinder pressed with friction, Goodman's coupling (Spence)."""
    return _evaluated("mfv_spence_cylinder_shear", x, normal_force, half_width, friction_coefficient, beta)


def spence_flat_punch_shear(
    x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike, friction_coefficient: ArrayLike, beta: ArrayLike
) -> NDArray[np.float64]:
    """Shear traction at x under a flat punch pressed with friction, Goodman's coupling (Spence)."""
    return _evaluated("mfv_spence_flat_punch_shear", x, normal_force, half_width, friction_coefficient, beta)


def mindlin_stick_ratio(
    tangential_force: ArrayLike, normal_force: ArrayLike, friction_coefficient: ArrayLike
) -> NDArray[np.float64]:
    """Width of the stuck zone over that of the contact of a cylinder pressed, then sheared (Cattaneo, Mindlin)."""
    return _evaluated("mfv_mindlin_stick_ratio", tangential_force, normal_force, friction_coefficient)


def mindlin_shear(
    x: ArrayLike,
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    friction_coefficient: ArrayLike,
) -> NDArray[np.float64]:
    """Shear traction at x under a cylinder pressed, then sheared by a growing force (Cattaneo, Mindlin)."""
    return _evaluated("mfv_mindlin_shear", x, tangential_force, normal_force, half_width, friction_coefficient)


def mindlin_dissipation(
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    radius: ArrayLike,
    friction_coefficient: ArrayLike,
) -> NDArray[np.float64]:
    """Energy that a cylinder dissipates in a cycle of shear between +Q and -Q, per unit thickness (Mindlin)."""
    return _evaluated(
        "mfv_mindlin_dissipation", tangential_force, normal_force, half_width, radius, friction_coefficient
    )


def carter_creepage(
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    radius: ArrayLike,
    friction_coefficient: ArrayLike,
) -> NDArray[np.float64]:
    """Sliding per rolled distance of two similar cylinders in steady rolling to the right (Carter).

    1/radius = 1/R1 + 1/R2. Rolling to the left the creepage has the other sign.
    """
    return _evaluated("mfv_carter_creepage", tangential_force, normal_force, half_width, radius, friction_coefficient)


def carter_shear(
    x: ArrayLike,
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    friction_coefficient: ArrayLike,
) -> NDArray[np.float64]:
    """Shear traction at x, from the middle of the contact, of similar cylinders that roll to the right (Carter)."""
    return _evaluated("mfv_carter_shear", x, tangential_force, normal_force, half_width, friction_coefficient)


def wedge_half_width(
    normal_force: ArrayLike, slope: ArrayLike, shear_modulus: ArrayLike, kolosov_constant: ArrayLike
) -> NDArray[np.float64]:
    """Half-width of the contact of a rigid wedge with a half-plane; `slope`: tangent of the angle of a flank to the surface."""
    return power_half_width(normal_force, slope, 1.0, shear_modulus, kolosov_constant)


def wedge_pressure(x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike) -> NDArray[np.float64]:
    """Pressure at x under a wedge, large at its tip."""
    return power_pressure(x, normal_force, half_width, 1.0)


def wedge_stick_ratio(
    tangential_force: ArrayLike, normal_force: ArrayLike, friction_coefficient: ArrayLike
) -> NDArray[np.float64]:
    """Width of the stuck zone over that of the contact of a wedge pressed, then sheared: 1 - Q/(mu P)."""
    return power_stick_ratio(tangential_force, normal_force, friction_coefficient, 1.0)


def wedge_shear(
    x: ArrayLike,
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    friction_coefficient: ArrayLike,
) -> NDArray[np.float64]:
    """Shear traction at x under a wedge pressed, then sheared by a growing force."""
    return power_shear(x, tangential_force, normal_force, half_width, friction_coefficient, 1.0)


def power_half_width(
    normal_force: ArrayLike,
    coefficient: ArrayLike,
    exponent: ArrayLike,
    shear_modulus: ArrayLike,
    kolosov_constant: ArrayLike,
) -> NDArray[np.float64]:
    """Half-width of the contact of a rigid body of the shape coefficient |x|^exponent with a half-plane."""
    return _evaluated("mfv_power_half_width", normal_force, coefficient, exponent, shear_modulus, kolosov_constant)


def power_approach(
    half_width: ArrayLike, coefficient: ArrayLike, exponent: ArrayLike, datum: ArrayLike
) -> NDArray[np.float64]:
    """Approach of such a body to a half-plane's surface point at the distance `datum`."""
    return _evaluated("mfv_power_approach", half_width, coefficient, exponent, datum)


def power_pressure(
    x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike, exponent: ArrayLike
) -> NDArray[np.float64]:
    """Pressure at x under such a body."""
    return _evaluated("mfv_power_pressure", x, normal_force, half_width, exponent)


def power_stick_ratio(
    tangential_force: ArrayLike, normal_force: ArrayLike, friction_coefficient: ArrayLike, exponent: ArrayLike
) -> NDArray[np.float64]:
    """Width of the stuck zone over that of the contact of such a body pressed, then sheared (Jaeger, Ciavarella)."""
    return _evaluated("mfv_power_stick_ratio", tangential_force, normal_force, friction_coefficient, exponent)


def power_shear(
    x: ArrayLike,
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    friction_coefficient: ArrayLike,
    exponent: ArrayLike,
) -> NDArray[np.float64]:
    """Shear traction at x under such a body pressed, then sheared by a growing force (Jaeger, Ciavarella)."""
    return _evaluated("mfv_power_shear", x, tangential_force, normal_force, half_width, friction_coefficient, exponent)


def rounded_punch_half_width(
    normal_force: ArrayLike,
    flat_half_width: ArrayLike,
    edge_radius: ArrayLike,
    shear_modulus: ArrayLike,
    kolosov_constant: ArrayLike,
) -> NDArray[np.float64]:
    """Half-width of the contact of a rigid flat punch with rounded edges with a half-plane (Ciavarella, Hills and Monno)."""
    return _evaluated(
        "mfv_rounded_punch_half_width", normal_force, flat_half_width, edge_radius, shear_modulus, kolosov_constant
    )


def rounded_punch_approach(
    half_width: ArrayLike, flat_half_width: ArrayLike, edge_radius: ArrayLike, datum: ArrayLike
) -> NDArray[np.float64]:
    """Approach of such a punch to a half-plane's surface point at the distance `datum`."""
    return _evaluated("mfv_rounded_punch_approach", half_width, flat_half_width, edge_radius, datum)


def rounded_punch_pressure(
    x: ArrayLike, normal_force: ArrayLike, half_width: ArrayLike, flat_half_width: ArrayLike
) -> NDArray[np.float64]:
    """Pressure at x under such a punch."""
    return _evaluated("mfv_rounded_punch_pressure", x, normal_force, half_width, flat_half_width)


def rounded_punch_stick_ratio(
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    friction_coefficient: ArrayLike,
    half_width: ArrayLike,
    flat_half_width: ArrayLike,
) -> NDArray[np.float64]:
    """Width of the stuck zone over that of the contact of such a punch pressed, then sheared (Jaeger, Ciavarella)."""
    return _evaluated(
        "mfv_rounded_punch_stick_ratio", tangential_force, normal_force, friction_coefficient, half_width, flat_half_width
    )


def rounded_punch_shear(
    x: ArrayLike,
    tangential_force: ArrayLike,
    normal_force: ArrayLike,
    half_width: ArrayLike,
    friction_coefficient: ArrayLike,
    flat_half_width: ArrayLike,
) -> NDArray[np.float64]:
    """Shear traction at x under such a punch pressed, then sheared by a growing force (Jaeger, Ciavarella)."""
    return _evaluated(
        "mfv_rounded_punch_shear",
        x,
        tangential_force,
        normal_force,
        half_width,
        friction_coefficient,
        flat_half_width,
    )


def persson_force(
    half_angle: ArrayLike, clearance: ArrayLike, youngs_modulus: ArrayLike, poisson_ratio: ArrayLike
) -> NDArray[np.float64]:
    """Force at which the contact of a pin in a bore reaches `half_angle` (radians) to either side (Persson).

    Both of one material in plane strain, without friction. `clearance`: by how much the bore's radius is larger.
    """
    return _evaluated("mfv_persson_force", half_angle, clearance, youngs_modulus, poisson_ratio)


def yield_contact_arc(
    youngs_modulus: ArrayLike, poisson_ratio: ArrayLike, yield_strength: ArrayLike
) -> NDArray[np.float64]:
    """Contact arc 2a/R (radians) at which a cylinder pressed on a rigid plane without friction yields, plane strain."""
    return _evaluated("mfv_yield_contact_arc", youngs_modulus, poisson_ratio, yield_strength)


def _evaluated(function: str, *arguments: ArrayLike) -> NDArray[np.float64]:
    """A function of the library over arrays; a plain number for plain numbers."""
    values: NDArray[np.float64] = np.vectorize(getattr(library(), function), otypes=[np.float64])(*arguments)
    return values[()]
