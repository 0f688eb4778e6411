"""Every key of a case, one row each: the scene in which it makes sense, what it takes, and what is said where it is
missing. tests/cli/test_bad_input.py makes the faults of it; it fails where `--keys` names a key that has no row here."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

#: Groups of a scene as they are written: name, and keys with their values.
Groups = list[tuple[str, dict[str, str]]]

ELASTIC = {"shape": "'half_plane'", "shear_modulus": "1.0", "poisson_ratio": "0.3"}
RIGID_DISK = {"shape": "'disk'", "radius": "0.25", "rigid": ".true."}
ELASTIC_DISK = {"shape": "'disk'", "radius": "0.25", "shear_modulus": "1.0", "poisson_ratio": "0.3"}
RIGID_PLANE = {"shape": "'half_plane'", "rigid": ".true."}
EDGE = ELASTIC | {"shape": "'edge'", "normal_intensity": "0.02", "edge_length": "0.01"}
MESH = {"nodes": "11", "half_width": "0.02"}
PRESS = {"normal_force": "1e-3", "friction": ".false."}
SHEAR = {"tangential_force": "2e-4"}


def scene(
    lower: dict[str, str], upper: dict[str, str], mesh: dict[str, str], friction: dict[str, str], *steps: dict[str, str]
) -> Groups:
    groups: Groups = [("scene", {}), ("body", lower), ("body", upper), ("mesh", mesh), ("friction", friction)]
    return groups + [("step", step) for step in steps] + [("solver", {}), ("output", {})]


COULOMB = {"law": "'coulomb'", "mu": "0.7"}
ORTHOTROPIC = {
    "shape": "'half_plane'", "elasticity": "'orthotropic'", "youngs_modulus_1": "3.0", "youngs_modulus_2": "1.0", "youngs_modulus_3": "1.0",
    "poisson_ratio_12": "0.3", "poisson_ratio_13": "0.3", "poisson_ratio_23": "0.3", "shear_modulus_12": "0.5",
}  # fmt: skip
ANISOTROPIC = {"shape": "'half_plane'", "elasticity": "'anisotropic'", "compliances": "1, -0.3, 1, 0.1, 0, 2.6, -0.3, -0.3, 1, 0"}


def layered(material: dict[str, str]) -> Groups:
    """A scene with a layer of a material."""
    groups = scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS, SHEAR)
    return groups[:3] + [("layer", {"body": "1", "thickness": "0.004", **material})] + groups[3:]


#: Scenes in which keys make sense. The files that they name are made by the test.
SCENES: dict[str, Groups] = {
    "cylinder": scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS, SHEAR),
    "composite": scene(ORTHOTROPIC, RIGID_DISK, MESH, COULOMB, PRESS, SHEAR),
    "coated": layered({"youngs_modulus": "2.0", "poisson_ratio": "0.3"}),
    "coated composite": layered({key: value for key, value in ORTHOTROPIC.items() if key != "shape"}),
    "coated crystal": layered({key: value for key, value in ANISOTROPIC.items() if key != "shape"}),
    "crystal": scene(ANISOTROPIC, RIGID_DISK, MESH, COULOMB, PRESS, SHEAR),
    "free mesh": scene(ELASTIC, RIGID_DISK, {"nodes": "11"}, COULOMB, PRESS, SHEAR),
    "elastic disk": scene(ELASTIC_DISK, RIGID_PLANE, {"nodes": "12", "half_angle": "9"}, COULOMB, PRESS, SHEAR),
    "fourier": scene(ELASTIC_DISK | {"kernel": "'fourier'"}, RIGID_PLANE, {"nodes": "12", "half_angle": "9"}, COULOMB, PRESS),
    "bore": scene(ELASTIC_DISK, {"shape": "'hole'", "radius": "0.3", "rigid": ".true."}, MESH, {}, {"normal_force": "1e-3"}),
    "punch": scene(ELASTIC, {"shape": "'flat_punch'", "half_width": "0.015", "rigid": ".true."}, MESH, COULOMB, PRESS, SHEAR),
    "rounded punch": scene(
        ELASTIC,
        {"shape": "'rounded_punch'", "half_width": "0.01", "edge_radius": "0.1", "rigid": ".true."},
        MESH,
        {},
        {"normal_force": "1e-3"},
    ),
    "wedge": scene(ELASTIC, {"shape": "'wedge'", "angle": "3", "rigid": ".true."}, MESH, {}, {"normal_force": "1e-3"}),
    "power": scene(
        ELASTIC, {"shape": "'power'", "coefficient": "2.0", "exponent": "2", "rigid": ".true."}, MESH, {}, {"normal_force": "1e-3"}
    ),
    "elastic power": scene(
        ELASTIC, ELASTIC | {"shape": "'power'", "coefficient": "2.0", "exponent": "2"}, MESH, COULOMB, PRESS, SHEAR
    ),
    "wave": scene(
        ELASTIC,
        {"shape": "'wave'", "amplitude": "1e-3", "wavelength": "0.1", "rigid": ".true."},
        MESH,
        {},
        {"normal_force": "1e-3"},
    ),
    "edge": scene(ELASTIC, EDGE, MESH, COULOMB, {"normal_intensity": "0.02"}, {"shear_intensity": "1e-4"}),
    "profile": scene(
        ELASTIC, {"shape": "'profile'", "file": "'profile.txt'", "rigid": ".true."}, MESH, {}, {"normal_force": "1e-3"}
    ),
    "mu from a file": scene(ELASTIC, RIGID_DISK, MESH, {"law": "'coulomb'", "mu_file": "'mu.txt'"}, PRESS, SHEAR),
    "static_kinetic": scene(
        ELASTIC, RIGID_DISK, MESH, {"law": "'static_kinetic'", "mu_static": "0.7", "mu_kinetic": "0.5"}, PRESS, SHEAR
    ),
    "weakening": scene(
        ELASTIC,
        RIGID_DISK,
        MESH,
        {"law": "'weakening'", "mu_static": "0.7", "mu_kinetic": "0.5", "weakening_distance": "1e-4"},
        PRESS,
        SHEAR,
    ),
    "dahl": scene(ELASTIC, RIGID_DISK, MESH, {"law": "'dahl'", "mu": "0.7", "stiffness": "1e3", "exponent": "1"}, PRESS, SHEAR),
    "cycles": scene(
        ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS, SHEAR, {"tangential_force": "-2e-4", "cycles": "2", "steady_tolerance": "1e-6"}
    ),
    "history": scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS)
    + [("history", {"tangential_force": "1e-4, -1e-4", "period": "2", "cycles": "2", "steady_tolerance": "1e-6"})],
    "history of a file": scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS) + [("history", {"file": "'loads.csv'"})],
    "history of elastic bodies": scene(
        ELASTIC, ELASTIC | {"shape": "'power'", "coefficient": "2.0", "exponent": "2"}, MESH, COULOMB, PRESS
    )
    + [("history", {"tangential_force": "1e-4, -1e-4"})],
    "history of others": scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS) + [("history", {"shift": "1e-5"})],
    "wear": scene(ELASTIC, RIGID_DISK, MESH, COULOMB, PRESS, {"tangential_force": "2e-4", "cycles": "2"})
    + [("wear", {"coefficient": "1e-3", "tolerance": "0.1"})],
    "fit": scene(
        ELASTIC_DISK | {"shape": "'hole'"},
        ELASTIC_DISK,
        {"normals": "'radial'", "nodes": "12"},
        COULOMB,
        {"interference": "1e-3"},
        {"moment": "1e-6"},
    ),
    "history of a fit": scene(
        ELASTIC_DISK | {"shape": "'hole'"}, ELASTIC_DISK, {"normals": "'radial'", "nodes": "12"}, COULOMB, {"interference": "1e-3"}
    )
    + [("history", {"normal_force": "1e-4, -1e-4"})],
    "history of an edge": scene(ELASTIC, EDGE, MESH, COULOMB, {"normal_intensity": "0.02"})
    + [("history", {"shear_intensity": "1e-4, -1e-4"})],
    "rolling": scene(ELASTIC_DISK, RIGID_PLANE, MESH, COULOMB, PRESS, {"moment": "1e-6"}),
}


@dataclass(frozen=True)
class Row:
    """One key. `place`: its group, with a number where that repeats."""

    place: str
    #: The scene, and a value of the key that is right in it, as it is written.
    scene: str
    value: str
    #: real, whole, text, choice or logical.
    kind: str
    #: Range of a number; `above`: whether its lower end itself is refused.
    lower: float = -math.inf
    upper: float = math.inf
    above: bool = False
    choices: tuple[str, ...] = ()
    unit: str = ""
    is_list: bool = False
    #: What is said where the key is missing; empty: it may be missing.
    needed: str = ""
    #: Values of the right kind and in the range that the scene does not take, with what is then said.
    refused: dict[str, str] = field(default_factory=dict)
    #: Right values that take seconds: tried by scripts/deep-check.sh only.
    dear: tuple[str, ...] = ()
    #: Keys of the scene that have to go, because this one takes their place.
    without: tuple[str, ...] = ()

    @property
    def group(self) -> str:
        return self.place.partition("(")[0]

    @property
    def number(self) -> int:
        return int(self.place.partition("(")[2].rstrip(")") or 1)

    @property
    def right(self) -> str:
        """What messages say that the key takes."""
        if self.kind == "real":
            text = "a number"
            if self.lower > -math.inf:
                text += f" {'above' if self.above else 'at least'} {number(self.lower)}"
            return text + (f" and at most {number(self.upper)}" if self.upper < math.inf else "")
        if self.kind == "whole":
            return f"a whole number from {int(self.lower)} to {int(self.upper)}"
        if self.kind == "choice":
            *most, last = [f"'{choice}'" for choice in self.choices]
            return f"{', '.join(most)} or {last}"
        return {"text": "a text between quotes", "logical": ".true. or .false."}[self.kind]


def number(value: float) -> str:
    """A number as messages write it."""
    return f"{value:.6g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")


def text(place: str, scene: str, value: str, **more: object) -> Row:
    return Row(place, scene, value, "text", **more)  # type: ignore[arg-type]


def choice(place: str, scene: str, value: str, choices: str, **more: object) -> Row:
    return Row(place, scene, value, "choice", choices=tuple(choices.split()), **more)  # type: ignore[arg-type]


def logical(place: str, scene: str, value: str, **more: object) -> Row:
    return Row(place, scene, value, "logical", **more)  # type: ignore[arg-type]


def whole(place: str, scene: str, value: str, lower: float, upper: float, **more: object) -> Row:
    return Row(place, scene, value, "whole", lower=lower, upper=upper, **more)  # type: ignore[arg-type]


def real(place: str, scene: str, value: str, unit: str = "", **more: object) -> Row:
    return Row(place, scene, value, "real", unit=unit, **more)  # type: ignore[arg-type]


def positive(place: str, scene: str, value: str, unit: str = "", **more: object) -> Row:
    return real(place, scene, value, unit, lower=0.0, above=True, **more)


def part(place: str, scene: str, value: str, **more: object) -> Row:
    return real(place, scene, value, lower=1e-12, upper=1.0, **more)


SHAPES = "half_plane disk hole flat_punch rounded_punch wedge power profile matrix wave edge"
MODULUS = "force/length^2"
NO_FRICTION = "must be 0 in a step without friction (or where every coefficient is 0)"
BELOW_KINETIC = "must not be above mu_static"

#: Every key of a case: (group, key) and its row.
CASE: dict[tuple[str, str], Row] = {
    ("scene", "title"): text("scene", "cylinder", "'A title'"),
    ("scene", "plane"): choice("scene", "cylinder", "'strain'", "strain stress"),
    ("scene", "coupling"): choice("scene", "cylinder", "'full'", "full goodman none"),
    ("scene", "length_unit"): text("scene", "cylinder", "'mm'"),
    ("scene", "force_unit"): text("scene", "cylinder", "'N'"),
    ("body", "shape"): choice(
        "body(1)",
        "cylinder",
        "'half_plane'",
        SHAPES,
        needed=": shape is missing; it must be 'half_plane'",
        refused={
            "'disk'": "radius is missing",
            "'hole'": "radius is missing",
            "'flat_punch'": "must be .true. for a flat_punch",
            "'rounded_punch'": "half_width is missing",
            "'wedge'": "angle is missing",
            "'power'": "coefficient is missing",
            "'wave'": "amplitude is missing",
            "'edge'": "normal_intensity is missing",
            "'profile'": "has no effect|file is missing",
            "'matrix'": "has no effect",
        },
    ),
    ("body", "rigid"): logical(
        "body(2)", "cylinder", ".true.", refused={".false.": "poisson_ratio is missing", "f": "poisson_ratio is missing"}
    ),
    ("body", "shear_modulus"): positive(
        "body(1)", "cylinder", "1.0", MODULUS, needed=": shear_modulus is missing; it must be a number above 0"
    ),
    ("body", "youngs_modulus"): positive("body(1)", "cylinder", "2.6", MODULUS, without=("shear_modulus",)),
    ("body", "poisson_ratio"): real(
        "body(1)",
        "cylinder",
        "0.3",
        lower=-1.0,
        above=True,
        upper=0.5,
        needed=": poisson_ratio is missing; it must be a number above -1 and at most 0.5",
    ),
    ("body", "yield_strength"): positive("body(1)", "cylinder", "1.0", MODULUS),
    ("body", "datum"): positive("body(1)", "cylinder", "0.25", "length"),
    ("body", "radius"): positive(
        "body(2)", "cylinder", "0.25", "length", needed=": radius is missing; it must be a number above 0"
    ),
    ("body", "half_width"): positive(
        "body(2)", "punch", "0.015", "length", needed=": half_width is missing; it must be a number above 0"
    ),
    ("body", "edge_radius"): positive(
        "body(2)", "rounded punch", "0.1", "length", needed=": edge_radius is missing; it must be a number above 0"
    ),
    ("body", "angle"): real(
        "body(2)",
        "wedge",
        "3",
        "degrees",
        lower=0.0,
        above=True,
        upper=80.0,
        needed=": angle is missing; it must be a number above 0 and at most 80",
    ),
    ("body", "coefficient"): positive(
        "body(2)", "power", "2.0", "length^(1-exponent)", needed=": coefficient is missing; it must be a number above 0"
    ),
    ("body", "exponent"): real(
        "body(2)",
        "power",
        "2",
        lower=1.0,
        upper=100.0,
        needed=": exponent is missing; it must be a number at least 1 and at most 100",
    ),
    ("body", "amplitude"): positive(
        "body(2)", "wave", "1e-3", "length", needed=": amplitude is missing; it must be a number above 0"
    ),
    ("body", "wavelength"): positive(
        "body(2)", "wave", "0.1", "length", needed=": wavelength is missing; it must be a number above 0"
    ),
    ("body", "normal_intensity"): positive(
        "body(2)",
        "edge",
        "0.02",
        "force/length^(5/2)",
        needed=": normal_intensity is missing; it must be a number above 0",
        refused={"1e-100": "is too large beside the normal_intensity of the body"},
    ),
    ("body", "edge_length"): positive(
        "body(2)", "edge", "0.01", "length", needed=": edge_length is missing; it must be a number above 0"
    ),
    ("body", "elasticity"): choice(
        "body(1)",
        "bore",
        "'own'",
        "own half_plane orthotropic anisotropic",
        refused={"'orthotropic'": "has no effect for a disk with", "'anisotropic'": "has no effect for a disk with"},
    ),
    **{
        ("body", name): positive(
            "body(1)",
            "composite",
            ORTHOTROPIC[name],
            MODULUS,
            needed=f": {name} is missing; it must be a number above 0",
            refused=dict.fromkeys(unstable, "no such material"),
        )
        for name, unstable in (
            ("youngs_modulus_1", ("1e-100", "1e-15")),
            ("youngs_modulus_2", ("1e100", "1e-100", "1e-15")),
            ("youngs_modulus_3", ("1e100",)),
            ("shear_modulus_12", ()),
        )
    },
    **{
        ("body", name): real(
            "body(1)",
            "composite",
            "0.3",
            needed=f": {name} is missing; it must be a number",
            refused=dict.fromkeys(("1e100", "-1e100"), "no such material"),
        )
        for name in ("poisson_ratio_12", "poisson_ratio_13", "poisson_ratio_23")
    },
    ("body", "compliances"): real(
        "body(1)",
        "crystal",
        ANISOTROPIC["compliances"],
        "length^2/force",
        is_list=True,
        needed=": compliances is missing; it must be a number",
        refused=dict.fromkeys(("1e100", "-1e100", "1e-100", "-1e-100", "1e-400", "-0.0", "0"), "must be ten numbers"),
    ),
    ("body", "axis_angle"): real("body(1)", "composite", "0", "degrees", lower=-180.0, upper=180.0),
    ("body", "kernel"): choice("body(1)", "elastic disk", "'exact'", "exact fourier"),
    ("body", "harmonics"): whole(
        "body(1)",
        "fourier",
        "150",
        2,
        200000000,
        dear=("200000000",),
        refused={"2": "must be at least 120, half the 240 intervals of the circle"},
    ),
    ("body", "file"): text(
        "body(2)",
        "profile",
        "'profile.txt'",
        needed=": file is missing; it must be a text between quotes",
        refused={"''": "must not be empty"},
    ),
    ("body", "interpolation"): choice("body(2)", "profile", "'linear'", "linear monotone_cubic"),
    ("body", "position_scale"): positive("body(2)", "profile", "1"),
    ("body", "height_scale"): real(
        "body(2)", "profile", "1", refused=dict.fromkeys(("0", "0.0", "-0.0", "1e-400"), "must not be 0")
    ),
    ("body", "level"): choice("body(2)", "profile", "'none'", "none mean line parabola"),
    ("body", "centred"): logical("body(2)", "profile", ".false."),
    ("mesh", "nodes"): whole(
        "mesh", "cylinder", "11", 1, 100000000, refused={"100000000": "can be more than 1000000 only with half_angle=180"}
    ),
    ("mesh", "half_width"): positive("mesh", "cylinder", "0.02", "length"),
    ("mesh", "half_angle"): real("mesh", "elastic disk", "9", "degrees", lower=0.0, above=True, upper=180.0),
    ("mesh", "period"): positive("mesh", "cylinder", "0.04", "length", without=("half_width",)),
    ("mesh", "refine"): choice("mesh", "cylinder", "'edges'", "none edges"),
    ("mesh", "ends"): real(
        "mesh",
        "cylinder",
        "-0.02, -0.005, 0.004, 0.02",
        "length",
        is_list=True,
        without=("nodes", "half_width"),
        refused=dict.fromkeys(("1e100", "-1e100", "1e-100", "-1e-100", "1e-400", "-0.0", "0"), "at least two values"),
    ),
    ("mesh", "gap"): choice("mesh", "cylinder", "'exact'", "exact parabolic"),
    ("mesh", "normals"): choice("mesh", "bore", "'radial'", "vertical radial"),
    ("friction", "law"): choice(
        "friction",
        "cylinder",
        "'coulomb'",
        "none coulomb static_kinetic weakening dahl",
        refused={
            "'none'": "has no effect with law='none'",
            "'static_kinetic'": "has no effect with law='static_kinetic'",
            "'weakening'": "has no effect with law='weakening'",
            "'dahl'": "stiffness is missing",
        },
    ),
    ("friction", "mu"): real(
        "friction",
        "cylinder",
        "0.7",
        lower=0.0,
        is_list=True,
        refused=dict.fromkeys(("0", "0.0", "-0.0", "1e-400"), NO_FRICTION),
        needed=": mu is missing; it must be a number at least 0",
    ),
    ("friction", "mu_static"): real(
        "friction",
        "static_kinetic",
        "0.7",
        lower=0.0,
        is_list=True,
        refused=dict.fromkeys(("1e-100",), BELOW_KINETIC) | dict.fromkeys(("0", "0.0", "-0.0", "1e-400"), NO_FRICTION),
        needed=": mu_static is missing; it must be a number at least 0",
    ),
    ("friction", "mu_kinetic"): real(
        "friction",
        "static_kinetic",
        "0.5",
        lower=0.0,
        is_list=True,
        refused=dict.fromkeys(("1e100",), BELOW_KINETIC),
        needed=": mu_kinetic is missing; it must be a number at least 0",
    ),
    ("friction", "mu_file"): text(
        "friction",
        "mu from a file",
        "'mu.txt'",
        refused={"''": "must not be empty"},
        needed=": mu is missing; it must be a number at least 0",
    ),
    ("friction", "weakening_distance"): positive(
        "friction", "weakening", "1e-4", "length", needed=": weakening_distance is missing; it must be a number above 0"
    ),
    ("friction", "stiffness"): positive(
        "friction", "dahl", "1e3", "force/length^3", needed=": stiffness is missing; it must be a number above 0"
    ),
    ("friction", "exponent"): real("friction", "dahl", "1", lower=0.0, upper=100.0, dear=("100.0",)),
    ("wear", "law"): choice("wear", "wear", "'work'", "archard work"),
    ("wear", "coefficient"): positive(
        "wear", "wear", "1e-3", "length^2/force", needed=": coefficient is missing; it must be a number above 0"
    ),
    ("wear", "tolerance"): real("wear", "wear", "0.05", lower=1e-6, upper=1.0),
    ("wear", "block"): whole("wear", "wear", "5", 1, 1000000, without=("tolerance",)),
    ("step", "normal_force"): real(
        "step(1)",
        "cylinder",
        "1e-3",
        "force/length",
        needed=": needs a target: normal_force or approach",
        refused=dict.fromkeys(("-1e-3", "-1e-100", "-1e100"), "must be a number at least 0"),
    ),
    ("step", "approach"): real("step(1)", "cylinder", "1e-3", "length", without=("normal_force",)),
    ("step", "tangential_force"): real("step(2)", "cylinder", "2e-4", "force/length", needed=": needs a target: normal_force or"),
    ("step", "shift"): real("step(2)", "cylinder", "1e-5", "length", without=("tangential_force",)),
    ("step", "force_ratio"): real("step(2)", "cylinder", "0.4", lower=-1e6, upper=1e6, without=("tangential_force",)),
    ("step", "moment"): real("step(2)", "rolling", "1e-6", "force"),
    ("step", "rotation"): real("step(2)", "rolling", "1e-6", "radians", without=("moment",)),
    ("step", "lower_bulk_stress"): real("step(2)", "cylinder", "1e-3", "force/length^2"),
    ("step", "upper_bulk_stress"): real("step(2)", "elastic power", "1e-3", "force/length^2"),
    ("step", "interference"): real(
        "step(1)", "fit", "1e-3", "length", lower=0.0, needed=": needs a target: normal_force or approach"
    ),
    ("step", "normal_intensity"): real(
        "step(1)",
        "edge",
        "0.02",
        "force/length^(5/2)",
        lower=0.0,
        needed=": needs a target: normal_force or",
        refused={"1e100": "is too large beside the normal_intensity"},
    ),
    ("step", "shear_intensity"): real("step(2)", "edge", "1e-4", "force/length^(3/2)", needed=": needs a target: normal_force or"),
    ("step", "friction"): logical("step(2)", "cylinder", ".true.", refused={".false.": NO_FRICTION, "f": NO_FRICTION}),
    ("step", "cycles"): whole("step(3)", "cycles", "2", 0, 1000000, refused={"0": "has no effect without cycles of 2 or more"}),
    ("step", "steady_tolerance"): positive("step(3)", "cycles", "1e-6"),
    ("history", "file"): text(
        "history",
        "history of a file",
        "'loads.csv'",
        needed=": needs a file, or lists of loads such as tangential_force",
        refused={"''": "must not be empty"},
    ),
    ("history", "normal_force"): real(
        "history",
        "history",
        "9e-4",
        "force/length",
        is_list=True,
        refused=dict.fromkeys(("-1e-3", "-1e-100", "-1e100"), "must be at least 0"),
    ),
    ("history", "approach"): real("history", "history", "1e-3", "length", is_list=True),
    ("history", "tangential_force"): real("history", "history of others", "1e-4", "force/length", is_list=True, without=("shift",)),
    ("history", "shift"): real("history", "history of others", "1e-5", "length", is_list=True, needed=": needs a file, or lists"),
    ("history", "force_ratio"): real(
        "history", "history of others", "0.4", lower=-1e6, upper=1e6, is_list=True, without=("shift",)
    ),
    ("history", "moment"): real("history", "history", "1e-6", "force", is_list=True),
    ("history", "rotation"): real("history", "history", "1e-6", "radians", is_list=True),
    ("history", "lower_bulk_stress"): real("history", "history", "1e-3", "force/length^2", is_list=True),
    ("history", "upper_bulk_stress"): real("history", "history of elastic bodies", "1e-3", "force/length^2", is_list=True),
    ("history", "interference"): real("history", "history of a fit", "2e-3", "length", lower=0.0, is_list=True),
    ("history", "normal_intensity"): real(
        "history",
        "history of an edge",
        "0.02",
        "force/length^(5/2)",
        lower=0.0,
        is_list=True,
        refused={"1e100": "is too large beside the normal_intensity"},
    ),
    ("history", "shear_intensity"): real("history", "history of an edge", "1e-4", "force/length^(3/2)", is_list=True),
    ("history", "period"): whole("history", "history", "2", 2, 1000000, refused={"1000000": "must be at most 2, the number of"}),
    ("history", "cycles"): whole("history", "history", "2", 1, 1000000, refused={"1": "has no effect without cycles of 2 or more"}),
    ("history", "steady_tolerance"): positive("history", "history", "1e-6"),
    ("solver", "algorithm"): choice("solver", "cylinder", "'mfv'", "mfv conventional"),
    ("solver", "stepping"): choice("solver", "cylinder", "'event'", "auto event nominal leap"),
    ("solver", "accuracy"): real("solver", "cylinder", "1e-3", lower=0.0, upper=0.1),
    ("solver", "load_step"): part("solver", "cylinder", "0.05"),
    ("solver", "integration"): choice("solver", "dahl", "'explicit'", "second_order explicit"),
    ("solver", "friction_tolerance"): part("solver", "dahl", "1e-4", dear=("1e-12",)),
    ("solver", "iterations"): whole("solver", "cylinder", "1000", 1, 1000000),
    ("solver", "linear_solver"): choice("solver", "cylinder", "'auto'", "auto dgesv reduced fft"),
    ("solver", "linear_tolerance"): part("solver", "cylinder", "1e-12"),
    ("output", "file"): text("output", "cylinder", "'result.h5'", refused={"''": "must not be empty"}),
    ("output", "history"): choice("output", "cylinder", "'events'", "events steps none"),
    ("output", "states"): choice("output", "cylinder", "'auto'", "auto reversals steps none last_cycle"),
    ("output", "error_estimate"): logical("output", "cylinder", ".false."),
    ("output", "sensitivity"): logical("output", "cylinder", ".false."),
    ("output", "stress_at"): real("output", "cylinder", "1e-3", "length"),
    ("output", "checkpoint_minutes"): real("output", "cylinder", "10", "minutes", lower=0.0, upper=1e6),
}
#: Layers have the keys of materials of bodies.
_OF_MATERIALS = (*(key for key in ORTHOTROPIC if key != "shape"), "poisson_ratio", "yield_strength", "compliances", "axis_angle")
_TOO_DIFFERENT = {"youngs_modulus_1": ("1e100",), "shear_modulus_12": ("1e-100", "1e-15")}
_COATED = {"cylinder": "coated", "composite": "coated composite", "crystal": "coated crystal"}
CASE.update(
    {
        ("layer", "body"): whole(
            "layer(1)", "coated", "1", 1, 2, needed=": body is missing; it must be a whole number from 1 to 2"
        ),
        ("layer", "thickness"): positive(
            "layer(1)", "coated", "0.004", "length", needed=": thickness is missing; it must be a number above 0"
        ),
        ("layer", "elasticity"): choice(
            "layer(1)",
            "coated",
            "'isotropic'",
            "isotropic orthotropic anisotropic",
            refused=dict.fromkeys(("'orthotropic'", "'anisotropic'"), "has no effect with elasticity="),
        ),
        **{
            ("layer", name): replace(
                row,
                place="layer(1)",
                scene=_COATED[row.scene],
                refused=row.refused | dict.fromkeys(_TOO_DIFFERENT.get(name, ()), "differ too much"),
            )
            for (group, name), row in CASE.items()
            if group == "body" and row.scene in _COATED and name in _OF_MATERIALS
        },
        ("layer", "shear_modulus"): positive("layer(1)", "coated", "0.8", MODULUS, without=("youngs_modulus",)),
        ("layer", "youngs_modulus"): positive(
            "layer(1)", "coated", "2.0", MODULUS, needed=": shear_modulus is missing; it must be a number above 0"
        ),
    }
)
