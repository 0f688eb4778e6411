"""Random problems over the whole feature space, each from its seed."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from .problem import Keys, Problem

#: From these seeds on some bodies are anisotropic, most surfaces repeat, most bodies have layers, pins are pressed into bores, and
#: surfaces are rough; the numbers of smaller seeds do not change.
ANISOTROPIC = 200_000
PERIODIC = 300_000
LAYERED = 400_000
FITS = 500_000
ROUGH = 600_000


class Draw:
    """Random numbers of a seed."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)

    def between(self, low: float, high: float) -> float:
        return float(self.random.uniform(low, high))

    def power(self, low: float, high: float) -> float:
        """Ten to a random power."""
        return 10.0 ** self.between(low, high)

    def whole(self, low: int, high: int) -> int:
        return int(self.random.integers(low, high + 1))

    def chance(self, probability: float) -> bool:
        return bool(self.random.random() < probability)

    def one_of(self, **weights: float) -> str:
        """A name with a probability in proportion to its weight."""
        names = list(weights)
        shares = np.array([weights[name] for name in names])
        return names[int(np.searchsorted(np.cumsum(shares / shares.sum()), self.random.random(), side="right"))]

    def sign(self) -> int:
        return 1 if self.chance(0.5) else -1


class Sizes:
    """Scales of a contact: half-width a, force P, approach, shift at the limit of sliding, friction, modulus E* (force/length^2)."""

    half_width = force = approach = shift = mu = modulus = datum = 1.0
    mesh_half_width: float | None = None
    has_punch = can_strain_lower = can_strain_upper = can_roll = False


def problem(seed: int) -> Problem:
    """The problem of a seed."""
    if seed >= ROUGH:
        return _rough(Draw(seed))
    if seed >= FITS:
        return _fit(Draw(seed))
    draw, sizes = Draw(seed), Sizes()
    made = Problem([("scene", {})])
    scene = made.one("scene")
    if draw.chance(0.25):
        scene["plane"] = "stress"
    scene["coupling"] = draw.one_of(full=0.5, goodman=0.25, none=0.25)
    _add_bodies(draw, made, sizes, Draw(seed + 2**32) if ANISOTROPIC <= seed < LAYERED else None)
    layers = Draw(seed + 2**34)
    if seed >= LAYERED and made.labels["shape"] != "pin":
        _add_layers(layers, made, sizes)
    law = _add_friction(draw, made, sizes)
    loads = _add_loads(draw, made, sizes, law)
    mesh = _add_mesh(draw, made, sizes, law, loads)
    repeats = seed >= PERIODIC and (seed < LAYERED or layers.chance(0.3))
    if repeats and made.labels["shape"] != "pin" and loads != "rotation" and not _has_bulk_stress(made):
        _repeat(Draw(seed + 2**33), made, sizes)
    _add_solver(draw, made, law, mesh)
    made.one("output").update(states="steps", history="steps", error_estimate=True)
    made.labels.update(law=law, loads=loads, mesh=mesh)
    smooth = made.labels["shape"] in ("cylinder", "disks", "hole", "power", "rounded")
    made.ordinary = smooth and law in ("none", "coulomb") and not made.has("wear")
    return made


def _fit(draw: Draw) -> Problem:
    """A pin in a bore of its radius, with or without interference, under loads in all directions."""
    sizes = Sizes()
    made = Problem([("scene", {"coupling": draw.one_of(full=0.7, none=0.3)})])  # with radial normals Goodman's is solved by dgesv
    if draw.chance(0.25):
        made.one("scene")["plane"] = "stress"
    plane = made.one("scene").get("plane", "strain")
    radius = sizes.half_width = draw.power(-3, 3)
    bodies: list[Keys] = [{"shape": "hole", "radius": radius}, {"shape": "disk", "radius": radius}]
    sizes.modulus = _add_materials(draw, bodies, plane, rigid=0.25, alike=0.3)
    strain = draw.power(-4, -2)
    is_pressed = draw.chance(0.65)
    pressure = 0.5 * strain * sizes.modulus
    sizes.force = radius * pressure * draw.between(0.3, 4.0)
    sizes.datum, sizes.approach = radius, sizes.force / sizes.modulus
    if draw.chance(0.4):
        bodies.reverse()
    made.groups += [("body", body) for body in bodies]
    made.labels["shape"] = "fit"
    law = _add_friction(draw, made, sizes)
    grip = sizes.mu * (sizes.force + (2 * np.pi * radius * pressure if is_pressed else 0.0))
    if is_pressed:
        made.groups.append(("step", {"interference": strain * radius}))
        if law != "none" and draw.chance(0.3):
            made.groups[-1][1]["friction"] = False
    loads = _add_loads_of_fit(draw, made, sizes, grip * draw.between(0.1, 0.6))
    made.groups.append(
        ("mesh", {"normals": "radial", "nodes": draw.whole(24, 36) if law in ("dahl", "weakening") else draw.whole(40, 90)})
    )
    _add_solver(draw, made, law, "given")
    made.one("output").update(states="steps", history="steps", error_estimate=True)
    made.labels.update(law=law, loads=loads, mesh="fit")
    made.ordinary = law in ("none", "coulomb")
    return made


def _add_loads_of_fit(draw: Draw, made: Problem, sizes: Sizes, shear: float) -> str:
    """A force, then one kind of load history; `shear`: a tangential force that does not slide everything."""
    down = sizes.force * (-1 if draw.chance(0.25) else 1)
    made.groups.append(("step", {"normal_force": down}))
    kind = draw.one_of(press=1, shear=2, torque=2, cycles=3, rotating=2, release=1, shift=1)
    if not made.has("friction"):
        kind = draw.one_of(press=1, release=1)
    radius = sizes.half_width
    if kind == "press":
        made.groups.append(("step", {"normal_force": down * draw.between(0.2, 2.0)}))
    elif kind == "release":
        made.groups.append(("step", {"normal_force": 0.0 if draw.chance(0.5) else 0.1 * down}))
        made.groups.append(("step", {"normal_force": down}))
    elif kind == "shear":
        made.groups.append(("step", {"tangential_force": draw.sign() * shear}))
    elif kind == "torque":
        made.groups += [("step", {"moment": draw.sign() * radius * shear}), ("step", {"moment": 0.3 * radius * shear})]
    elif kind == "shift":
        made.groups.append(("step", {"shift": draw.sign() * shear / sizes.modulus}))
    elif kind == "cycles":
        name, size = ("moment", radius * shear) if draw.chance(0.3) else ("tangential_force", shear)
        made.groups += [("step", {name: size}), ("step", {name: -size * draw.between(0.5, 1.0), "cycles": draw.whole(1, 3)})]
    else:
        angles = np.linspace(0, 2 * np.pi, draw.whole(6, 16))[1:]
        table = {"normal_force": (down * np.cos(angles)).tolist(), "tangential_force": (down * np.sin(angles)).tolist()}
        made.tables["turn.csv"] = table
        made.groups.append(("history", {"file": "turn.csv", "cycles": draw.whole(1, 2)}))
    return kind


def _rough(draw: Draw) -> Problem:
    """A self-affine surface that repeats, or on a cylinder: pressed, sheared, cycles."""
    sizes = Sizes()
    made = Problem([("scene", {"coupling": draw.one_of(full=0.4, none=0.45, goodman=0.15)})])
    if draw.chance(0.25):
        made.one("scene")["plane"] = "stress"
    plane = made.one("scene").get("plane", "strain")
    length, slope = draw.power(-3, 3), draw.power(-3, -0.8)
    repeats = draw.chance(0.7)
    kind = draw.one_of(given=0.6, points=0.2, default=0.2)
    profile, shortest = _self_affine(draw, made, length, slope, 10 if kind == "default" else 40)
    bodies: list[Keys] = [{"shape": "half_plane"}, profile]
    sizes.modulus = _add_materials(draw, bodies, plane, rigid=0.5, alike=0.25)
    # The length in contact is about the force over E* and the slope.
    share = draw.power(-1.7, -0.3)
    sizes.force = share * slope * sizes.modulus * length
    sizes.half_width = 0.5 * share * length
    if not repeats:
        table = made.tables["profile.csv"]
        half = length * draw.between(0.15, 0.35)
        curvature = 8 * sizes.force / (np.pi * sizes.modulus * half**2)  # Hertz: half of the force of this contact
        height = np.array(table["height"]) + 0.5 * curvature * np.array(table["x"]) ** 2
        table["height"] = (height - height.min()).tolist()
    if draw.chance(0.4):
        bodies.reverse()
    made.groups += [("body", body) for body in bodies]
    made.labels["shape"] = "rough, repeats" if repeats else "rough"
    law = draw.one_of(coulomb=0.85, none=0.15)
    if law == "coulomb":
        sizes.mu = draw.power(-1.2, 0.0)
        made.groups.append(("friction", {"law": law, "mu": sizes.mu}))
    else:
        sizes.mu = 0.0
    press: Keys = {"normal_force": sizes.force}
    if law != "none" and draw.chance(0.5):
        press["friction"] = False
    made.groups.append(("step", press))
    loads = draw.one_of(press=1, shear=3, cycles=4, forces=2) if law != "none" else draw.one_of(press=1, forces=1)
    _LOADS[loads](draw, made, sizes)
    costly = made.one("scene")["coupling"] != "none"
    mesh: Keys = {"period": length} if repeats else {"half_width": 0.5 * length}
    if kind == "points":  # a node at every point
        mesh["nodes"] = len(made.tables["profile.csv"]["x"]) - 1
    elif kind == "given":  # from two to twenty on the shortest wave
        mesh["nodes"] = int(np.clip(length / shortest * draw.power(0.3, 1.3), 24, 120 if costly else 400))
    elif not repeats:
        mesh.pop("half_width")
    if mesh:
        made.groups.append(("mesh", mesh))
    _add_solver(draw, made, law, kind)
    made.one("output").update(states="steps", history="steps", error_estimate=True)
    made.labels.update(law=law, loads=loads, mesh=kind)
    return made


def _self_affine(draw: Draw, made: Problem, length: float, slope: float, most: int) -> tuple[Keys, float]:
    """One period of a self-affine surface with a roll-off and at most a number of its shortest waves, on two to sixteen points a wave,
    straight or smooth between them; its keys and the shortest wave."""
    shortest, roll_off = draw.whole(6, most), draw.whole(1, 5)
    numbers = np.arange(1, shortest + 1)
    hurst = draw.between(0.3, 1.0)
    amplitude = np.maximum(numbers, roll_off) ** (-0.5 - hurst) * draw.random.normal(size=(2, shortest))
    count = int(shortest * draw.power(0.35, 1.2))
    x = length * (np.arange(count + 1) / count - 0.5)
    waves = 2 * np.pi / length * numbers
    height = amplitude[0] @ np.cos(np.outer(waves, x)) + amplitude[1] @ np.sin(np.outer(waves, x))
    height *= slope / np.sqrt(0.5 * np.sum((amplitude * waves) ** 2))
    height[-1] = height[0]
    keys: Keys = {"shape": "profile", "file": "profile.csv"}
    kind = "smooth" if draw.chance(0.6) else "straight"
    if kind == "smooth":
        keys["interpolation"] = "monotone_cubic"
    made.tables["profile.csv"] = {"x": x.tolist(), "height": (height - height.min()).tolist()}
    made.labels["profile"] = kind
    return keys, length / shortest


def _add_materials(draw: Draw, bodies: list[Keys], plane: str, rigid: float, alike: float) -> float:
    """Give the bodies materials; `rigid`, `alike`: the shares of scenes in which one is rigid, or both have one. The contact modulus."""
    hard = draw.whole(0, 1) if draw.chance(rigid) else None
    common = _material(draw) if draw.chance(alike) else None
    for number, body in enumerate(bodies):
        body.update({"rigid": True} if number == hard else common or _material(draw))
    return 2 / sum(compliance(body, plane) for body in bodies)


def _material(draw: Draw) -> Keys:
    ratio = draw.between(0.0, 0.49) if draw.chance(0.93) else draw.between(-0.5, 0.5)
    return {"shear_modulus": draw.power(-2, 5), "poisson_ratio": ratio}


def _make_anisotropic(draw: Draw, body: Keys, plane: str) -> None:
    """Give an isotropic body an orthotropic or anisotropic material of about its stiffness."""
    shear = body.pop("shear_modulus")
    body.pop("poisson_ratio")
    body["axis_angle"] = draw.between(-90, 90) if draw.chance(0.7) else 0.0
    moduli = [2.6 * shear * draw.power(-0.6, 0.6) for _ in range(3)]
    ratios = [draw.between(-0.2, 0.45) * math.sqrt(moduli[i] / moduli[j]) for i, j in ((0, 1), (0, 2), (1, 2))]
    shear *= draw.power(-0.4, 0.4)
    if draw.chance(0.7):
        body["elasticity"] = "orthotropic"
        body.update({f"youngs_modulus_{i + 1}": modulus for i, modulus in enumerate(moduli) if i < 2 or plane == "strain"})
        body.update({f"poisson_ratio_{name}": ratios[i] for i, name in enumerate(("12", "13", "23")) if i < 1 or plane == "strain"})
        body["shear_modulus_12"] = shear
        return
    body["elasticity"] = "anisotropic"
    in_plane = [1 / moduli[0], -ratios[0] / moduli[0], 1 / moduli[1]]
    skew = [draw.between(-0.5, 0.5) * math.sqrt(modulus / shear) for modulus in (in_plane[0], in_plane[2])]
    body["compliances"] = [*in_plane, *skew, 1 / shear]
    if plane == "strain":
        body["compliances"] += [-ratios[1] / moduli[0], -ratios[2] / moduli[1], 1 / moduli[2], 0.0]


def _anisotropic_compliance(body: Keys, plane: str) -> float:
    """The compliance A of the surface of an anisotropic body under pressure, length^2/force (docs/theory.md)."""
    if body["elasticity"] == "orthotropic":
        e1, e2, nu12, g12 = (body[key] for key in ("youngs_modulus_1", "youngs_modulus_2", "poisson_ratio_12", "shear_modulus_12"))
        s = np.array([[1 / e1, -nu12 / e1, 0], [-nu12 / e1, 1 / e2, 0], [0, 0, 1 / g12]])
        if plane == "strain":
            out = np.array([-body["poisson_ratio_13"] / e1, -body["poisson_ratio_23"] / e2, 0])
            s -= np.outer(out, out) * body["youngs_modulus_3"]
    else:
        s11, s12, s22, s16, s26, s66 = body["compliances"][:6]
        s = np.array([[s11, s12, s16], [s12, s22, s26], [s16, s26, s66]])
        if plane == "strain":
            s13, s23, s33, s36 = body["compliances"][6:]
            s -= np.outer([s13, s23, s36], [s13, s23, s36]) / s33
    c, q = math.cos(math.radians(body["axis_angle"])), math.sin(math.radians(body["axis_angle"]))
    stress = np.array([[c * c, q * q, 2 * q * c], [q * q, c * c, -2 * q * c], [-q * c, q * c, c * c - q * q]])
    s = stress.T @ s @ stress
    roots = np.roots([s[0, 0], -2 * s[0, 2], 2 * s[0, 1] + s[2, 2], -2 * s[1, 2], s[1, 1]])
    return float(-s[1, 1] * np.sum(1 / roots[roots.imag > 0]).imag)


def compliance(body: Keys, plane: str) -> float:
    """(kappa + 1)/(4 G), length^2/force."""
    if body.get("rigid"):
        return 0.0
    if "axis_angle" in body:
        return _anisotropic_compliance(body, plane)
    nu = body["poisson_ratio"]
    kappa = (3 - nu) / (1 + nu) if plane == "stress" else 3 - 4 * nu
    return (kappa + 1) / (4 * body["shear_modulus"])


def _add_bodies(draw: Draw, made: Problem, sizes: Sizes, anisotropy: Draw | None) -> None:
    """The bodies; with a draw for their `anisotropy` some are anisotropic half-planes."""
    kind = draw.one_of(cylinder=20, disks=8, hole=7, pin=3, power=10, wedge=7, rounded=12, flat=6, profile=22)
    radius, share = draw.power(-3, 3), draw.power(-2.0, -1.0)
    a = sizes.half_width = radius * share
    lower: Keys = {"shape": "half_plane"}
    slope: Callable[[np.ndarray], np.ndarray] = lambda x: x / radius  # noqa: E731
    if kind in ("cylinder", "disks", "hole", "pin"):
        upper: Keys = {"shape": "disk", "radius": radius}
        if kind != "cylinder":
            other = radius * {"disks": draw.power(0, 0.5), "hole": draw.between(1.3, 3), "pin": 1 + draw.power(-4, -1)}[kind]
            lower = {"shape": "disk" if kind == "disks" else "hole", "radius": other}
            curvature = 1 / radius + (1 if kind == "disks" else -1) / other
            if kind == "pin":
                a = sizes.half_width = radius * draw.between(0.05, 0.5)
            slope = lambda x: curvature * x  # noqa: E731
    elif kind == "power":
        exponent = draw.between(1.3, 6.0) if draw.chance(0.8) else 2.0
        coefficient = 0.5 * share * a ** (1 - exponent)
        upper = {"shape": "power", "coefficient": coefficient, "exponent": exponent}
        slope = lambda x: coefficient * exponent * x ** (exponent - 1)  # noqa: E731
    elif kind == "wedge":
        angle = draw.between(0.2, 8.0)
        upper = {"shape": "wedge", "angle": angle}
        slope = lambda x: np.full_like(x, math.tan(math.radians(angle)))  # noqa: E731
    elif kind == "rounded":
        flat = a * draw.between(0.3, 0.97)
        upper = {"shape": "rounded_punch", "half_width": flat, "edge_radius": radius}
        slope = lambda x: np.maximum(x - flat, 0) / radius  # noqa: E731
    elif kind == "flat":
        upper = {"shape": "flat_punch", "half_width": a, "rigid": True}
        sizes.has_punch = True
        slope = lambda x: np.full_like(x, share * 0.1)  # noqa: E731
    else:
        upper = _profile(draw, made, a, radius)
    bodies = [lower, upper]
    rigid = 1 if draw.chance(0.45) else (0 if draw.chance(0.1) and kind != "flat" else None)
    alike = _material(draw) if draw.chance(0.25) else None
    for number, body in enumerate(bodies):
        if number == rigid or "rigid" in body:
            body["rigid"] = True
        else:
            body.update(alike or _material(draw))
    plane = made.one("scene").get("plane", "strain")
    if anisotropy and kind != "pin":
        # Two bodies of one material keep it, along the same axes or not.
        made_of = anisotropy.whole(0, 2**30)
        for body in bodies:
            if not body.get("rigid") and anisotropy.chance(0.7):
                _make_anisotropic(Draw(made_of) if alike else anisotropy, body, plane)
    sizes.modulus = 2 / sum(compliance(body, plane) for body in bodies)
    angles = (np.arange(400) + 0.5) * np.pi / 800
    sizes.force = float(sizes.modulus * np.mean(slope(a * np.sin(angles)) * a * np.sin(angles)) * np.pi / 2)
    if kind == "profile":
        sizes.force *= draw.power(-0.7, 0.3)
    round_ones = [body["radius"] for body in bodies if "radius" in body]
    sizes.datum = max(round_ones) if round_ones else a * draw.power(0.7, 2)
    if not round_ones and draw.chance(0.8):
        for body in bodies:
            if not body.get("rigid"):
                body["datum"] = sizes.datum
    sizes.approach = sizes.force / (np.pi * sizes.modulus / 2) * (0.5 + math.log(2 * sizes.datum / a)) / 2
    swapped = draw.chance(0.4)
    if swapped:
        bodies.reverse()
    flags = [not body.get("rigid") and body["shape"] not in ("disk", "hole") for body in bodies]
    sizes.can_strain_lower, sizes.can_strain_upper = flags
    sizes.can_roll = kind in ("cylinder", "disks")
    for body in bodies:
        made.groups.append(("body", body))
    made.labels["shape"] = kind


def _profile(draw: Draw, made: Problem, a: float, radius: float) -> Keys:
    """A measured profile: a parabola with waves or noise, or a smooth one with few points, or two bumps."""
    kind = draw.one_of(waves=4, noise=3, smooth=2, bumps=2)
    count = draw.whole(150, 700) if kind in ("waves", "noise") else draw.whole(60, 250)
    x = np.linspace(-2.0 * a, 2.0 * a, count)
    height = x**2 / (2 * radius)
    keys: Keys = {"shape": "profile", "file": "profile.csv"}
    if kind == "waves":
        length = a * draw.between(0.12, 1.0)
        height = height + draw.power(-1.5, 0.7) / radius * (length / (2 * np.pi)) ** 2 * np.cos(
            2 * np.pi * x / length + draw.between(0, 6.28)
        )
    elif kind == "noise":
        noise = draw.random.normal(size=count)
        window = np.ones(draw.whole(1, 8))
        noise = np.convolve(noise, window / window.size, mode="same")
        height = height + draw.power(-3.5, -1.0) * a**2 / radius * noise
    elif kind == "bumps":
        apart = a * draw.between(0.5, 1.2)
        height = np.minimum((x - apart) ** 2, (x + apart) ** 2 * draw.between(0.6, 1.5)) / (2 * radius)
    if kind == "smooth" or draw.chance(0.2):
        keys["interpolation"] = "monotone_cubic"
    made.tables["profile.csv"] = {"x": x.tolist(), "height": (height - height.min()).tolist()}
    made.labels["profile"] = kind
    return keys


def _add_friction(draw: Draw, made: Problem, sizes: Sizes) -> str:
    law = draw.one_of(none=6, coulomb=66, static_kinetic=6, weakening=9, dahl=6)
    if law in ("weakening", "dahl") and made.labels["shape"] in ("pin", "flat"):
        law = "coulomb"  # thousands of increments on the meshes of the truth
    mu = draw.power(-1.2, 0.0)
    sizes.mu = 0.0 if law == "none" else mu
    sizes.shift = mu * sizes.approach
    if law == "none":
        return law
    keys: Keys = {"law": law}
    names = ("mu",) if law in ("coulomb", "dahl") else ("mu_static", "mu_kinetic")
    values = {"mu": mu, "mu_static": mu, "mu_kinetic": mu * draw.between(0.6, 1.0)}
    if draw.chance(0.08):
        table: dict[str, list[float]] = {"x": [-draw.between(0.2, 1) * sizes.half_width, draw.between(0.2, 1) * sizes.half_width]}
        left, right = draw.between(0.7, 1), draw.between(0.7, 1)
        table.update({name: [values[name] * left, values[name] * right] for name in names})
        made.tables["mu.txt"] = table
        keys["mu_file"] = "mu.txt"
    else:
        keys.update({name: values[name] for name in names})
    slip = mu * sizes.force / sizes.modulus
    if law == "weakening":
        keys["weakening_distance"] = draw.power(-1, 1.5) * slip
    if law == "dahl":
        keys["stiffness"] = draw.power(1, 3) * sizes.modulus / sizes.half_width
        if draw.chance(0.3):
            keys["exponent"] = draw.between(0.3, 2.0)
    made.groups.append(("friction", keys))
    return law


def _add_loads(draw: Draw, made: Problem, sizes: Sizes, law: str) -> str:
    """The press, and then one kind of load history."""
    press: Keys = {"normal_force": sizes.force}
    rubs = law != "none"
    if rubs and draw.chance(0.5):
        press["friction"] = False
    kind = draw.one_of(press=6, shear=14, cycles=18, forces=16, shift=10, approach=6, bulk=12, signal=10, rotation=5, wear=7)
    if not rubs:
        kind = draw.one_of(press=3, forces=2, approach=1)
    if kind == "bulk" and not (sizes.can_strain_lower or sizes.can_strain_upper):
        kind = "cycles"
    if kind == "rotation" and not sizes.can_roll:
        kind = "shear"
    if kind == "wear" and law not in ("coulomb", "static_kinetic"):
        kind = "cycles"
    if kind == "approach" and draw.chance(0.5):
        press = {"approach": sizes.approach, **{key: value for key, value in press.items() if key == "friction"}}
    made.groups.append(("step", press))
    _LOADS[kind](draw, made, sizes)
    return kind


def _ratio(draw: Draw) -> float:
    """Part of the sliding limit, small ones among them."""
    return draw.sign() * (draw.between(0.15, 0.95) if draw.chance(0.8) else draw.power(-2.5, -0.8))


def _press(draw: Draw, made: Problem, sizes: Sizes) -> None:
    if draw.chance(0.4):
        made.groups.append(("step", {"normal_force": sizes.force * draw.between(0.2, 0.9)}))


def _shear(draw: Draw, made: Problem, sizes: Sizes) -> None:
    ratio = _ratio(draw)
    force = {"force_ratio": ratio} if draw.chance(0.3) else {"tangential_force": ratio * sizes.mu * sizes.force}
    if made.has("friction", "mu_file"):
        force = {"tangential_force": 0.8 * ratio * sizes.mu * sizes.force}
    made.groups.append(("step", force))
    if draw.chance(0.3):
        made.groups.append(("step", {"tangential_force": draw.between(-0.6, 0.6) * sizes.mu * sizes.force}))


def _cycles(draw: Draw, made: Problem, sizes: Sizes) -> None:
    limit = 0.7 * sizes.mu * sizes.force
    there = _ratio(draw) * limit
    back = -there if draw.chance(0.7) else _ratio(draw) * limit
    last: Keys = {"tangential_force": back, "cycles": draw.whole(1, 3)}
    if draw.chance(0.2):
        last.update(cycles=8, steady_tolerance=draw.power(-8, -4))
    if draw.chance(0.3):
        last["normal_force"] = sizes.force * draw.between(0.75, 0.98)
    made.groups += [("step", {"tangential_force": there}), ("step", last)]


def _forces(draw: Draw, made: Problem, sizes: Sizes) -> None:
    normal = 1.0
    for _ in range(draw.whole(2, 5)):
        step: Keys = {}
        if draw.chance(0.5) or sizes.mu == 0.0:
            normal = draw.between(0.3, 1.0)
            step["normal_force"] = normal * sizes.force
        if sizes.mu > 0.0:
            step["tangential_force"] = draw.between(-0.65, 0.65) * min(normal, 1.0) * sizes.mu * sizes.force
        made.groups.append(("step", step))


def _shift(draw: Draw, made: Problem, sizes: Sizes) -> None:
    there = _ratio(draw) * sizes.shift * draw.power(-0.3, 0.3)
    made.groups.append(("step", {"shift": there}))
    made.groups.append(
        ("step", {"shift": -there * draw.between(0.3, 1), **({"cycles": draw.whole(1, 3)} if draw.chance(0.6) else {})})
    )


def _approach(draw: Draw, made: Problem, sizes: Sizes) -> None:
    step: Keys = {"approach": sizes.approach * draw.between(0.5, 1.1)}
    if sizes.mu > 0.0:
        step["shift"] = _ratio(draw) * sizes.shift
    made.groups.append(("step", step))
    if sizes.mu > 0.0:
        made.groups.append(("step", {"shift": _ratio(draw) * sizes.shift, "cycles": draw.whole(1, 2)}))


def _bulk(draw: Draw, made: Problem, sizes: Sizes) -> None:
    """Shear with bulk stress in phase, out of phase, or in a turning history."""
    pressure = sizes.mu * sizes.force / sizes.half_width
    names = [name for name, can in (("lower", sizes.can_strain_lower), ("upper", sizes.can_strain_upper)) if can]
    if len(names) == 2 and draw.chance(0.6):
        names = [names[draw.whole(0, 1)]]
    stresses = {f"{name}_bulk_stress": draw.sign() * draw.power(-1.3, 0.5) * pressure for name in names}
    force = draw.between(0.1, 0.65) * draw.sign() * sizes.mu * sizes.force
    phase = draw.one_of(once=2, in_phase=2, quarter=3)
    if phase == "once":
        made.groups.append(("step", {"tangential_force": force, **stresses}))
    elif phase == "in_phase":
        made.groups.append(("step", {"tangential_force": force, **stresses}))
        back = {name: -value for name, value in stresses.items()}
        made.groups.append(("step", {"tangential_force": -force, **back, "cycles": draw.whole(1, 2)}))
    else:
        turns = (0.0, 1.0, 0.0, -1.0)
        loads: Keys = {"tangential_force": [force * turns[(i + 1) % 4] for i in range(4)]}
        loads.update({name: [value * turn for turn in turns] for name, value in stresses.items()})
        made.groups.append(("history", {**loads, "cycles": draw.whole(1, 2)}))


def _signal(draw: Draw, made: Problem, sizes: Sizes) -> None:
    """A recorded force: slow oscillation, noise, rounded to digits so that earlier values are met again."""
    count = draw.whole(8, 30)
    time = np.arange(count)
    signal = np.sin(2 * np.pi * time / draw.between(5, 20) + draw.between(0, 6)) + draw.power(-2, -0.5) * draw.random.normal(
        size=count
    )
    signal = np.round(0.6 * signal / np.max(np.abs(signal)), draw.whole(1, 4)) * sizes.mu * sizes.force
    table: dict[str, list[float]] = {"tangential_force": signal.tolist()}
    if draw.chance(0.3):
        table["normal_force"] = (sizes.force * (0.85 + 0.1 * np.cos(time))).tolist()
        table["tangential_force"] = (0.6 * signal).tolist()
    keys: Keys = {"file": "signal.csv"}
    if draw.chance(0.3):
        keys.update(cycles=2, period=min(count, draw.whole(3, 8)))
    made.tables["signal.csv"] = table
    made.groups.append(("history", keys))


def _rotation(draw: Draw, made: Problem, sizes: Sizes) -> None:
    curvature = sum(1 / body["radius"] for body in made.all("body") if "radius" in body)
    made.groups.append(("step", {"tangential_force": draw.between(-0.6, 0.6) * sizes.mu * sizes.force}))
    made.groups.append(("step", {"rotation": draw.sign() * draw.between(0.2, 1.2) * sizes.half_width * curvature}))
    sizes.mesh_half_width = 2.6 * sizes.half_width


def _wear(draw: Draw, made: Problem, sizes: Sizes) -> None:
    cycles = draw.whole(5, 25)
    depth = sizes.force / sizes.modulus
    pressure = sizes.force / sizes.half_width
    wear = draw.power(-2.5, 0.7) * depth / (pressure * sizes.shift * cycles)
    keys: Keys = {"coefficient": wear}
    if draw.chance(0.3):
        keys = {"law": "work", "coefficient": wear / sizes.mu}
    if draw.chance(0.2):
        keys["tolerance"] = draw.power(-2, -1)
    made.groups.insert(-1, ("wear", keys))
    if draw.chance(0.6):
        there = draw.between(0.2, 0.7) * sizes.mu * sizes.force
        last: Keys = {"tangential_force": -there * draw.between(0.5, 1), "cycles": cycles}
        if draw.chance(0.4):
            last["normal_force"] = sizes.force * draw.between(0.8, 1.0)
        made.groups += [("step", {"tangential_force": there}), ("step", last)]
    else:
        there = draw.power(-0.2, 0.7) * sizes.shift
        made.groups += [("step", {"shift": there}), ("step", {"shift": -there, "cycles": cycles})]


_LOADS: dict[str, Callable[[Draw, Problem, Sizes], None]] = {
    "press": _press,
    "shear": _shear,
    "cycles": _cycles,
    "forces": _forces,
    "shift": _shift,
    "approach": _approach,
    "bulk": _bulk,
    "signal": _signal,
    "rotation": _rotation,
    "wear": _wear,
}


def _add_mesh(draw: Draw, made: Problem, sizes: Sizes, law: str, loads: str) -> str:
    """Given or default nodes and half-width, unequal intervals, radial normals; returns the kind of the mesh."""
    shape = made.labels["shape"]
    keys: Keys = {}
    costly = loads in ("signal", "wear") or law == "dahl" or made.one("scene")["coupling"] == "full"
    nodes = int(draw.power(1.4, 1.65 if costly else 1.85))
    kind = draw.one_of(given=50, free=22, default=9, edges=10, ends=4)
    if shape == "pin":
        keys.update(normals="radial", gap="exact")
    elif made.labels["shape"] in ("cylinder", "disks") and draw.chance(0.3):
        keys["gap"] = "parabolic"
    if loads == "rotation" or law in ("dahl", "weakening") or shape == "pin":
        nodes = draw.whole(16, 22) if law == "dahl" else draw.whole(18, 28)
        kind = "given"
    if kind == "default" and costly:
        kind = "free"
    if kind == "edges" and (loads in ("wear", "signal") or shape in ("pin", "flat") or law == "static_kinetic"):
        kind = "given"
    if kind == "ends" and (shape not in ("cylinder", "rounded", "power") or made.has("friction", "mu_file") or costly):
        kind = "given"
    wide = sizes.mesh_half_width or (sizes.half_width if shape == "flat" else 1.3 * sizes.half_width)
    if shape == "profile":
        wide = 1.9 * sizes.half_width
    if kind == "edges":
        keys["refine"] = "edges"
        if draw.chance(0.6):
            keys["nodes"] = draw.whole(40, 64)
    elif kind == "ends":
        places = np.sin(np.linspace(-1.0, 1.0, nodes + 1) * 0.45 * np.pi)
        keys["ends"] = (wide * places / places[-1]).tolist()
    elif kind != "default":
        keys["nodes"] = nodes
        if kind == "given":
            keys["half_width"] = wide
    if keys:
        made.groups.append(("mesh", keys))
    return kind


def _repeat(draw: Draw, made: Problem, sizes: Sizes) -> None:
    """Let the surfaces repeat after a few widths of the contact."""
    if draw.chance(0.15):
        return
    period = sizes.half_width * (draw.between(2.2, 3.9) if made.labels["shape"] == "profile" else draw.between(2.1, 8.0))
    if not made.has("mesh"):
        made.groups.append(("mesh", {}))
    keys = made.one("mesh")
    keys.pop("half_width", None)
    keys["period"] = period
    if "ends" in keys and keys["ends"][-1] > 0.5 * period:
        keys["ends"] = [end * 0.5 * period / keys["ends"][-1] for end in keys["ends"]]
    for body in made.all("body"):
        body.pop("datum", None)
        if body["shape"] in ("disk", "hole") and not body.get("rigid"):
            body.setdefault("elasticity", "half_plane")


def _add_layers(draw: Draw, made: Problem, sizes: Sizes) -> None:
    """Coat bodies; a rigid one, too."""
    plane = made.one("scene").get("plane", "strain")
    softest = 0.0
    for number, body in enumerate(made.all("body"), start=1):
        if body["shape"] == "flat_punch" or draw.chance(0.4 if not body.get("rigid") else 0.75):
            continue
        stiffness = 2.6 / sizes.modulus if body.get("rigid") else compliance(body, plane)
        for _ in range(draw.whole(1, 2)):
            ratio = draw.between(0, 0.5)
            material: Keys = {"shear_modulus": draw.power(-0.7, 0.9) * (1 - ratio) / stiffness, "poisson_ratio": ratio}
            softest = max(softest, compliance(material, plane))
            if draw.chance(0.25):
                _make_anisotropic(draw, material, plane)
            made.groups.append(("layer", {"body": number, "thickness": sizes.half_width * draw.power(-1.0, 0.5), **material}))
        for key in ("elasticity", "kernel", "harmonics"):
            body.pop(key, None)
    # Not wider than without them.
    sizes.force /= max(1.0, 0.5 * softest * sizes.modulus)
    sizes.approach /= max(1.0, 0.5 * softest * sizes.modulus)


def _add_solver(draw: Draw, made: Problem, law: str, mesh: str) -> None:
    keys: Keys = {}
    solver = draw.one_of(auto=60, reduced=15, dgesv=10, fft=15)
    if solver != "auto" and not (solver == "fft" and mesh in ("edges", "ends")):
        keys["linear_solver"] = solver
    if law == "coulomb" and draw.chance(0.15):
        keys["accuracy"] = float(draw.one_of(**{"1e-2": 1, "3e-3": 1, "1e-3": 1}))
        if draw.chance(0.5) and not _has_bulk_stress(made):
            keys["stepping"] = "leap"
    elif law in ("coulomb", "static_kinetic") and draw.chance(0.06):
        keys["stepping"] = "nominal"
    if keys:
        made.groups.append(("solver", keys))


def _has_bulk_stress(made: Problem) -> bool:
    return any("bulk_stress" in key for loads in made.loads() for key in loads)


def describe(made: Problem) -> dict[str, Any]:
    """Labels for tables."""
    solver = made.one("solver") if made.has("solver") else {}
    return {**made.labels, "accuracy": solver.get("accuracy", 0.0), "solver": solver.get("linear_solver", "auto")}
