"""Scenes: bodies, mesh, friction, steps and settings as Python objects.

Every class has the keys of a group of docs/namelist.md, by their names; `None` omits a key. The library checks the values: its
messages are raised as exceptions when a case is made of the scene.
"""

from __future__ import annotations

import contextlib
import dataclasses
import numbers
import os
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from ctypes import byref, c_void_p
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, ClassVar, Literal, TypedDict, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _html, errors
from ._library import LARGEST_INTEGER, library, real_pointer, text_buffer, text_for, text_of, whole_text
from ._suggestions import suggestion
from .inputs import REPEATED, groups

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack
    from typing_extensions import dataclass_transform as _dataclass_transform

    from . import profiles
    from .case import Case
    from .result import Result
else:

    def _dataclass_transform(**_: Any) -> Callable[[Any], Any]:
        return lambda decorator: decorator


#: A coefficient of friction: one value, or one per node.
Coefficient = Union[float, Sequence[float], NDArray[np.float64]]
#: Several numbers, such as positions along the surface.
Numbers = Union[Sequence[float], NDArray[np.float64]]
#: Loads of turning points: one value for each, or one for all.
LoadList = Union[float, Sequence[float], NDArray[np.float64]]

#: Arrays in place of a file: datasets by name.
Data = Mapping[str, NDArray[np.float64]]

_Class = TypeVar("_Class")


@_dataclass_transform(kw_only_default=True, eq_default=False)
def _keywords_only(cls: type[_Class]) -> type[_Class]:
    """A dataclass with keywords only (before Python 3.10 arguments by position are not refused)."""
    options: dict[str, Any] = {"kw_only": True} if sys.version_info >= (3, 10) else {}
    return dataclasses.dataclass(eq=False, repr=False, **options)(cls)


class KeyGroup:
    """Base of the groups of a scene: optional keys, comparison by value, no unknown attributes."""

    #: Fields that are not keys of the namelist.
    _not_keys: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def key_names(cls) -> list[str]:
        """Names of the keys."""
        return [name for name in cls._names() if name not in cls._not_keys]

    @classmethod
    def _names(cls) -> list[str]:
        """Names of the keys and of the other fields; a subclass of a group has those of the group."""
        return [name for name in cls._group().__annotations__ if not name.startswith("_")]

    @classmethod
    def _group(cls) -> type[KeyGroup]:
        """The class of the group that this is or inherits from."""
        return next(kind for kind in cls.__mro__ if KeyGroup in kind.__bases__)

    def keys(self) -> dict[str, Any]:
        """The given keys with their values."""
        values = {name: getattr(self, name) for name in self.key_names()}
        return {name: value for name, value in values.items() if value is not None}

    def _everything(self) -> dict[str, Any]:
        """The given keys and other fields."""
        values = {name: getattr(self, name) for name in self._names()}
        return {name: value for name, value in values.items() if value is not None}

    def __new__(cls, *_: Any, **keys: Any) -> Self:
        """Raises TypeError for an unknown keyword, with a proposal; a subclass may have a constructor with others."""
        if cls.__init__ is cls._group().__init__:
            for name in keys:
                if unknown := cls._unknown(name):
                    raise TypeError(unknown)
        return super().__new__(cls)

    @classmethod
    def _unknown(cls, name: str) -> str:
        """The message about an unknown attribute; empty if there is such an attribute."""
        if any(name in getattr(kind, "__annotations__", ()) for kind in cls.__mro__):
            return ""
        return f"{cls.__name__} has no '{name}'{suggestion(name, [*cls.key_names(), *cls._not_keys])}"

    def __setattr__(self, name: str, value: Any) -> None:
        if unknown := self._unknown(name):
            raise AttributeError(unknown)
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, KeyGroup) or type(self) is not type(other):
            return NotImplemented
        return _same(self._everything(), other._everything())

    __hash__ = None  # type: ignore[assignment]  # its keys may change

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={_shown(value)}' for name, value in self._everything().items())})"

    def _repr_html_(self) -> str:
        return _html.table([(name, _shown(value)) for name, value in self._everything().items()], type(self).__name__)


@_keywords_only
class Layer(KeyGroup):
    """A layer bonded on a body: the keys of &layer, without `body`. Materials as those of bodies."""

    # keys of &layer
    thickness: float
    elasticity: Literal["isotropic", "orthotropic", "anisotropic"] | None = None
    shear_modulus: float | None = None
    youngs_modulus: float | None = None
    poisson_ratio: float | None = None
    yield_strength: float | None = None
    youngs_modulus_1: float | None = None
    youngs_modulus_2: float | None = None
    youngs_modulus_3: float | None = None
    poisson_ratio_12: float | None = None
    poisson_ratio_13: float | None = None
    poisson_ratio_23: float | None = None
    shear_modulus_12: float | None = None
    compliances: Numbers | None = None
    axis_angle: float | None = None
    # end of keys


class Material(TypedDict, total=False):
    """Keys of a material: those of &layer but the thickness and the kinds."""

    # keys of a material
    shear_modulus: float | None
    youngs_modulus: float | None
    poisson_ratio: float | None
    yield_strength: float | None
    youngs_modulus_1: float | None
    youngs_modulus_2: float | None
    youngs_modulus_3: float | None
    poisson_ratio_12: float | None
    poisson_ratio_13: float | None
    poisson_ratio_23: float | None
    shear_modulus_12: float | None
    compliances: Numbers | None
    axis_angle: float | None
    # end of keys


class Elastic(Material, total=False):
    """Keys of every body that may be elastic."""

    rigid: bool | None
    datum: float | None
    elasticity: Literal["own", "half_plane", "orthotropic", "anisotropic"] | None
    layers: Sequence[Layer] | None


class Round(Elastic, total=False):
    """Those of a disk or a hole."""

    kernel: Literal["exact", "fourier"] | None
    harmonics: int | None


class OfProfile(Elastic, total=False):
    """Those of a profile."""

    interpolation: Literal["linear", "monotone_cubic"] | None
    position_scale: float | None
    height_scale: float | None
    level: Literal["none", "mean", "line", "parabola"] | None
    centred: bool | None


if TYPE_CHECKING:

    class OfMeasuredProfile(OfProfile, profiles.Reading, total=False):
        """Those of a profile in a file, too."""


@_keywords_only
class Body(KeyGroup):
    """A body: the keys of &body. `data`: arrays in place of the `file` of a profile or a matrix. `layers`: bonded on it, from the
    surface down; on a rigid body they are all that deforms."""

    # keys of &body
    shape: Literal[
        "half_plane", "disk", "hole", "flat_punch", "rounded_punch", "wedge", "power", "profile", "matrix", "wave", "edge"
    ]
    rigid: bool | None = None
    shear_modulus: float | None = None
    youngs_modulus: float | None = None
    poisson_ratio: float | None = None
    yield_strength: float | None = None
    datum: float | None = None
    radius: float | None = None
    half_width: float | None = None
    edge_radius: float | None = None
    angle: float | None = None
    coefficient: float | None = None
    exponent: float | None = None
    amplitude: float | None = None
    wavelength: float | None = None
    normal_intensity: float | None = None
    edge_length: float | None = None
    elasticity: Literal["own", "half_plane", "orthotropic", "anisotropic"] | None = None
    youngs_modulus_1: float | None = None
    youngs_modulus_2: float | None = None
    youngs_modulus_3: float | None = None
    poisson_ratio_12: float | None = None
    poisson_ratio_13: float | None = None
    poisson_ratio_23: float | None = None
    shear_modulus_12: float | None = None
    compliances: Numbers | None = None
    axis_angle: float | None = None
    kernel: Literal["exact", "fourier"] | None = None
    harmonics: int | None = None
    file: str | os.PathLike[str] | None = None
    interpolation: Literal["linear", "monotone_cubic"] | None = None
    position_scale: float | None = None
    height_scale: float | None = None
    level: Literal["none", "mean", "line", "parabola"] | None = None
    centred: bool | None = None
    # end of keys
    data: Data | None = None
    layers: Sequence[Layer] | None = None

    _not_keys: ClassVar[tuple[str, ...]] = ("data", "layers")

    @classmethod
    def half_plane(cls, **elastic: Unpack[Elastic]) -> Body:
        """A half-plane. Elastic: `shear_modulus` or `youngs_modulus` [force/length^2], and `poisson_ratio`; or `elasticity`
        'orthotropic' or 'anisotropic' with the keys of such a material (docs/namelist.md)."""
        return cls(shape="half_plane", **elastic)

    @classmethod
    def disk(cls, radius: float, **others: Unpack[Round]) -> Body:
        """A solid disk of a radius [length]; its load acts at its centre."""
        return cls(shape="disk", radius=radius, **others)

    @classmethod
    def hole(cls, radius: float, **others: Unpack[Round]) -> Body:
        """The infinite plane around a hole of a radius [length]."""
        return cls(shape="hole", radius=radius, **others)

    @classmethod
    def flat_punch(cls, half_width: float) -> Body:
        """A rigid flat punch with sharp edges; `half_width` [length]."""
        return cls(shape="flat_punch", rigid=True, half_width=half_width)

    @classmethod
    def rounded_punch(cls, half_width: float, edge_radius: float, **elastic: Unpack[Elastic]) -> Body:
        """Flat over |x| < `half_width`; the edges recede by (|x| - half_width)^2/(2 edge_radius) [length]."""
        return cls(shape="rounded_punch", half_width=half_width, edge_radius=edge_radius, **elastic)

    @classmethod
    def wedge(cls, angle: float, **elastic: Unpack[Elastic]) -> Body:
        """Two flanks that meet at x = 0; `angle`: of either flank to the common tangent [degrees]."""
        return cls(shape="wedge", angle=angle, **elastic)

    @classmethod
    def power(cls, coefficient: float, exponent: float, **elastic: Unpack[Elastic]) -> Body:
        """The surface recedes by coefficient |x|^exponent; `coefficient` [length^(1-exponent)], `exponent` at least 1."""
        return cls(shape="power", coefficient=coefficient, exponent=exponent, **elastic)

    @classmethod
    def wave(cls, amplitude: float, wavelength: float, **elastic: Unpack[Elastic]) -> Body:
        """The surface recedes by amplitude (1 - cos(2 pi x/wavelength)) [length]; with `period` in Mesh it repeats."""
        return cls(shape="wave", amplitude=amplitude, wavelength=wavelength, **elastic)

    @classmethod
    def profile(
        cls, x: ArrayLike | str | os.PathLike[str], height: ArrayLike | None = None, **others: Unpack[OfMeasuredProfile]
    ) -> Body:
        """A nearly flat surface through points: positions `x`, increasing, and how far it recedes from the other body [length]; points
        whose height is NaN are omitted. A negative `height_scale` is for heights that are positive outwards.

        Or the profile in a file, a text or that of an instrument: `Body.profile("scan.opd", unit="mm")`, with the options of
        `mfv.profiles.read`; its heights are positive outwards, unless its heading says recess or with `outwards=False`. Its notes are
        warnings of Python. Raises OSError, InputError, ModuleNotFoundError.
        """
        keys: dict[str, Any] = dict(others)
        if not isinstance(x, (str, os.PathLike)):
            if height is None:
                raise TypeError("Body.profile needs x and height, or the name of a file")
            return cls(shape="profile", data={"x": _numbers(x, "x"), "height": _numbers(height, "height")}, **keys)
        if height is not None:
            raise TypeError("Body.profile takes the name of a file, or x and height, not both")
        from . import profiles

        known = profiles.Reading.__annotations__
        for name in keys:
            if name not in known and cls._unknown(name):
                hint = "; did you mean outwards=False?" if name == "inwards" else suggestion(name, [*known, *cls.key_names()])
                raise TypeError(f"Body.profile has no '{name}'{hint}")
        options = {name: keys.pop(name) for name in known if name in keys}
        return cls(shape="profile", data=_measured(x, **options), **keys)

    @classmethod
    def edge(cls, normal_intensity: float, edge_length: float, **elastic: Unpack[Elastic]) -> Body:
        """A contact edge by itself, beside a half-plane: at the half-width `edge_length` [length] the pressure at the distance s from
        the right edge is `normal_intensity` sqrt(s) [force/length^(5/2)]."""
        return cls(shape="edge", normal_intensity=normal_intensity, edge_length=edge_length, **elastic)

    @classmethod
    def matrix(
        cls,
        x: ArrayLike,
        *,
        compliance: ArrayLike | None = None,
        stiffness: ArrayLike | None = None,
        gap: ArrayLike | None = None,
        width: ArrayLike | None = None,
    ) -> Body:
        """An elastic body by the compliance or the stiffness of its n surface nodes at `x`, increasing [length].

        `compliance`: (n, n), or (2n, 2n) with friction: displacements due to nodal forces per unit thickness, the normal
        components of all nodes before the tangential ones; `stiffness`: its inverse. `gap` (n): distance by which the surface
        recedes; `width` (n): length of the surface that belongs to each node. See docs/namelist.md for signs.
        """
        arrays = {"x": x, "gap": gap, "width": width, "compliance": compliance, "stiffness": stiffness}
        return cls(shape="matrix", data={name: _numbers(values, name) for name, values in arrays.items() if values is not None})


@_keywords_only
class Mesh(KeyGroup):
    """The mesh: the keys of &mesh."""

    # keys of &mesh
    nodes: int | None = None
    half_width: float | None = None
    half_angle: float | None = None
    period: float | None = None
    refine: Literal["none", "edges"] | None = None
    ends: Numbers | None = None
    gap: Literal["exact", "parabolic"] | None = None
    normals: Literal["vertical", "radial"] | None = None
    # end of keys


@_keywords_only
class Friction(KeyGroup):
    """Friction: the keys of &friction. `data`: arrays in place of `mu_file`."""

    # keys of &friction
    law: Literal["none", "coulomb", "static_kinetic", "weakening", "dahl"] | None = None
    mu: Coefficient | None = None
    mu_static: Coefficient | None = None
    mu_kinetic: Coefficient | None = None
    mu_file: str | os.PathLike[str] | None = None
    weakening_distance: float | None = None
    stiffness: float | None = None
    exponent: float | None = None
    # end of keys
    data: Data | None = None

    _not_keys: ClassVar[tuple[str, ...]] = ("data",)

    @classmethod
    def coulomb(cls, mu: Coefficient, *, x: ArrayLike | None = None) -> Friction:
        """A node sticks below mu p and slips at mu p. `mu`: one value, one per node, or with `x` one per position: linear between
        positions, constant beyond."""
        return cls(law="coulomb", **_coefficients(x, mu=mu))

    @classmethod
    def static_kinetic(cls, mu_static: Coefficient, mu_kinetic: Coefficient, *, x: ArrayLike | None = None) -> Friction:
        """A node sticks up to mu_static p and slips at mu_kinetic p; results depend on the mesh. Coefficients as in `coulomb`."""
        return cls(law="static_kinetic", **_coefficients(x, mu_static=mu_static, mu_kinetic=mu_kinetic))

    @classmethod
    def weakening(cls, mu_static: Coefficient, mu_kinetic: Coefficient, distance: float, *, x: ArrayLike | None = None) -> Friction:
        """The coefficient falls linearly from mu_static to mu_kinetic over a slip `distance` [length]."""
        coefficients = _coefficients(x, mu_static=mu_static, mu_kinetic=mu_kinetic)
        return cls(law="weakening", weakening_distance=distance, **coefficients)

    @classmethod
    def dahl(cls, mu: Coefficient, stiffness: float, *, exponent: float | None = None, x: ArrayLike | None = None) -> Friction:
        """Bristles of a `stiffness` [force/length^3] yield before mu p is reached."""
        return cls(law="dahl", stiffness=stiffness, exponent=exponent, **_coefficients(x, mu=mu))


@_keywords_only
class Wear(KeyGroup):
    """Wear of the surfaces in steps with cycles: the keys of &wear. `coefficient`: depth over pressure times slip (law='archard')
    or over the work of friction per unit of surface (law='work') [length^2/force]."""

    # keys of &wear
    coefficient: float
    law: Literal["archard", "work"] | None = None
    tolerance: float | None = None
    block: int | None = None
    # end of keys


@_keywords_only
class Step(KeyGroup):
    """One step of the load history: the keys of &step. Targets are reached linearly; loads without a target are constant."""

    # keys of &step
    normal_force: float | None = None
    approach: float | None = None
    tangential_force: float | None = None
    shift: float | None = None
    force_ratio: float | None = None
    moment: float | None = None
    rotation: float | None = None
    lower_bulk_stress: float | None = None
    upper_bulk_stress: float | None = None
    interference: float | None = None
    normal_intensity: float | None = None
    shear_intensity: float | None = None
    friction: bool | None = None
    cycles: int | None = None
    steady_tolerance: float | None = None
    # end of keys


@_keywords_only
class History(KeyGroup):
    """A load history after the steps: the keys of &history. Loads have one value per turning point, or one for all of them.

    The last `period` turning points are passed through `cycles` times.
    """

    # keys of &history
    file: str | os.PathLike[str] | None = None
    normal_force: LoadList | None = None
    approach: LoadList | None = None
    tangential_force: LoadList | None = None
    shift: LoadList | None = None
    force_ratio: LoadList | None = None
    moment: LoadList | None = None
    rotation: LoadList | None = None
    lower_bulk_stress: LoadList | None = None
    upper_bulk_stress: LoadList | None = None
    interference: LoadList | None = None
    normal_intensity: LoadList | None = None
    shear_intensity: LoadList | None = None
    period: int | None = None
    cycles: int | None = None
    steady_tolerance: float | None = None
    # end of keys

    @classmethod
    def from_table(
        cls, table: Any, *, period: int | None = None, cycles: int | None = None, steady_tolerance: float | None = None
    ) -> History:
        """The turning points in a pandas DataFrame, a dict of arrays or a structured array: columns named like the loads of a step.

        A column `time` is ignored. Raises TypeError for a column with another name.
        """
        names = getattr(getattr(table, "dtype", None), "names", None) or list(table.keys())
        loads: dict[str, Any] = {name: _numbers(table[name], name) for name in names if name != "time"}
        return cls(**loads, period=period, cycles=cycles, steady_tolerance=steady_tolerance)


@_keywords_only
class Solver(KeyGroup):
    """The solver: the keys of &solver."""

    # keys of &solver
    algorithm: Literal["mfv", "conventional"] | None = None
    accuracy: float | None = None
    stepping: Literal["auto", "event", "nominal", "leap"] | None = None
    load_step: float | None = None
    integration: Literal["second_order", "explicit"] | None = None
    friction_tolerance: float | None = None
    iterations: int | None = None
    linear_solver: Literal["auto", "dgesv", "reduced", "fft"] | None = None
    linear_tolerance: float | None = None
    # end of keys


@_keywords_only
class Output(KeyGroup):
    """The output: the keys of &output."""

    # keys of &output
    file: str | os.PathLike[str] | None = None
    history: Literal["events", "steps", "none"] | None = None
    states: Literal["auto", "reversals", "steps", "none", "last_cycle"] | None = None
    stress_at: float | None = None
    error_estimate: bool | None = None
    sensitivity: bool | None = None
    checkpoint_minutes: float | None = None
    # end of keys


class Scene(KeyGroup):
    """Two bodies with their friction and load history, and the keys of &scene. `lower` is below, `upper` above."""

    lower: Body
    upper: Body
    friction: Friction | None
    mesh: Mesh | None
    wear: Wear | None
    steps: list[Step]
    history: History | None
    solver: Solver | None
    output: Output | None
    name: str
    title: str | None
    plane: Literal["strain", "stress"] | None
    coupling: Literal["full", "goodman", "none"] | None
    length_unit: str | None
    force_unit: str | None

    _not_keys = ("lower", "upper", "friction", "mesh", "wear", "steps", "history", "solver", "output", "name")

    def __init__(
        self,
        lower: Body,
        upper: Body,
        *,
        friction: Friction | None = None,
        mesh: Mesh | None = None,
        wear: Wear | None = None,
        steps: Iterable[Step] = (),
        history: History | None = None,
        solver: Solver | None = None,
        output: Output | None = None,
        title: str | None = None,
        plane: Literal["strain", "stress"] | None = None,
        coupling: Literal["full", "goodman", "none"] | None = None,
        length_unit: str | None = None,
        force_unit: str | None = None,
        name: str = "scene",
    ) -> None:
        """`name`: the name of the scene in messages; paths of files are relative to its directory. Raises TypeError for an
        argument of the wrong class."""
        given = locals()
        for attribute in self._names():
            setattr(self, attribute, given[attribute])
        self.steps = list(steps)
        self._check_parts()

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Scene:
        """The scene of a namelist file. Raises OSError, InputError."""
        return cls.from_text(os.fsdecode(Path(path).read_bytes()), os.fspath(path))

    @classmethod
    def from_text(cls, text: str, name: str = "text") -> Scene:
        """The scene of a namelist text; `name` as for a new one. Raises InputError for an invalid text."""
        from .case import Case

        Case.from_text(text, name).close()  # checked here, so that messages can name the line
        with _scene_handle(text, name) as handle:
            return cls._of_groups(groups(_text_of_scene(handle)), name)

    @classmethod
    def _of_groups(cls, parts: Sequence[tuple[str, dict[str, Any]]], name: str) -> Scene:
        """The scene of groups by name."""
        layers = [(keys.pop("body"), Layer(**keys)) for group, keys in parts if group == "layer"]
        bodies = [Body(**keys) for group, keys in parts if group == "body"]
        for number, body in enumerate(bodies, start=1):
            body.layers = [layer for of, layer in layers if of == number] or None
        steps = [Step(**keys) for group, keys in parts if group == "step"]
        single = {group: keys for group, keys in parts if group not in REPEATED}
        settings: dict[str, Any] = {group: kind(**single[group]) for group, kind in _SINGLE.items() if group in single}
        lower, upper = bodies
        return cls(lower, upper, steps=steps, name=name, **settings, **single.get("scene", {}))

    def text(self) -> str:
        """The scene as a namelist text, without arrays: `file` names them, such as 'lower body'. Raises InputError."""
        with self._handle() as handle:
            return _text_of_scene(handle)

    @property
    def has_arrays(self) -> bool:
        """Whether the scene has arrays, which its text does not contain."""
        return any(getattr(part, "data", None) is not None for part in (self.lower, self.upper, self.friction))

    def contact(self) -> Case:
        """A case of this scene, to advance step by step. Raises InputError."""
        from .case import Case

        return Case(self)

    def run(self, *, output: str | os.PathLike[str] | None = None, check: bool = False, progress: bool = False) -> Result:
        """Solve it and return the result: see `mfv.run`."""
        from .case import run

        return run(self, output=output, check=check, progress=progress)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        here, there = self._everything(), other._everything()
        return _same({**here, "name": None}, {**there, "name": None})

    __hash__ = None

    def _repr_html_(self) -> str:
        parts = [(name.replace("body(1)", "lower").replace("body(2)", "upper"), part) for name, part in self._parts()]
        rows = [(name, _shown(value)) for name, value in self.keys().items() if name != "title"]
        rows += [(name, f"{part!r}".partition("(")[2][:-1]) for name, part in parts]
        return _html.table(rows, self.title or "Scene")

    def _parts(self) -> list[tuple[str, KeyGroup]]:
        """The groups of the namelist with their numbers, without &scene."""
        parts: list[tuple[str, KeyGroup]] = [("body(1)", self.lower), ("body(2)", self.upper)]
        parts += [(f"layer({number})", layer) for number, (_, layer) in enumerate(self._layers(), start=1)]
        parts += [(name, getattr(self, name)) for name in _SINGLE if getattr(self, name) is not None]
        return parts + [(f"step({number})", step) for number, step in enumerate(self.steps, start=1)]

    def _layers(self) -> list[tuple[int, Layer]]:
        """The layers of both bodies with the number of their body, in the order of the namelist."""
        return [(number, layer) for number, body in enumerate((self.lower, self.upper), start=1) for layer in body.layers or ()]

    def _data_of_instrument(self, body: Body) -> Data | None:
        """The points of a profile whose file is not a text, in `length_unit`; None for others. Raises InputError."""
        if body.shape != "profile" or body.file is None:
            return None
        from . import tables

        path = os.path.join(os.path.dirname(os.fspath(self.name)), os.fspath(body.file))
        if not os.path.isfile(path) or tables.is_text(path):
            return None
        if not body.position_scale == body.height_scale is None:
            raise errors.input_error(f"{path}: has units; remove position_scale and height_scale")
        return _measured(path, unit=self.length_unit or "mm")

    def _check_parts(self) -> None:
        """Raises TypeError for an attribute of the wrong class."""
        for name in ("lower", "upper"):
            _check_kind(name, getattr(self, name), Body)
            for number, layer in enumerate(getattr(self, name).layers or ()):
                _check_kind(f"layers[{number}] of the {name} body", layer, Layer)
        for name, kind in _SINGLE.items():
            if getattr(self, name) is not None:
                _check_kind(name, getattr(self, name), kind)
        for number, step in enumerate(self.steps):
            _check_kind(f"steps[{number}]", step, Step)

    @contextlib.contextmanager
    def _handle(self) -> Iterator[c_void_p]:
        """A scene of the library with all keys and arrays, freed afterwards. Raises TypeError, InputError."""
        self._check_parts()
        with _scene_handle("", self.name) as handle:
            statuses = _set_keys(handle, "scene", self.keys())
            bodies_of_layers = iter([number for number, _ in self._layers()])
            for group, part in self._parts():
                keys, data = part.keys(), getattr(part, "data", None)
                if isinstance(part, Layer):
                    keys["body"] = next(bodies_of_layers)
                if isinstance(part, Body) and data is None:
                    data = self._data_of_instrument(part)
                if data is not None:
                    file = keys.setdefault("file" if isinstance(part, Body) else "mu_file", _NAMES_OF_DATA[group])
                    statuses += [_set_data(handle, file, dataset, values) for dataset, values in data.items()]
                if isinstance(part, Step):
                    keys = keys or {"friction": True}  # the default; a step needs a key to exist
                statuses += _set_keys(handle, group, keys)
            if any(statuses):  # mfv_create reports the first failure
                created("mfv_create", handle)
            yield handle


#: Groups that occur at most once, without &scene.
_SINGLE: dict[str, type[KeyGroup]] = {
    "mesh": Mesh,
    "friction": Friction,
    "wear": Wear,
    "history": History,
    "solver": Solver,
    "output": Output,
}

#: Default names of arrays.
_USUAL: dict[type[KeyGroup], str] = {
    Body: "Body.disk(0.25, rigid=True)",
    Layer: "Layer(thickness=0.01, youngs_modulus=400.0, poisson_ratio=0.25)",
    Mesh: "Mesh(nodes=101, half_width=0.012)",
    Friction: "Friction.coulomb(0.7)",
    Wear: "Wear(coefficient=1.0e-8)",
    Step: "Step(normal_force=1.0e-3)",
    History: "History(tangential_force=[2.0e-4, -2.0e-4], cycles=3)",
    Solver: "Solver(linear_solver='fft')",
    Output: "Output(history='none')",
}
_NAMES_OF_DATA = {"body(1)": "lower body", "body(2)": "upper body", "friction": "friction"}


def _check_kind(name: str, part: Any, kind: type[KeyGroup]) -> None:
    """Raises TypeError if an attribute of a scene is of the wrong class."""
    if not isinstance(part, kind):
        raise TypeError(f"{name} of a Scene must be a mfv.{kind.__name__}, such as {_USUAL[kind]}, not {part!r}")


def _numbers(values: ArrayLike, name: str = "an array") -> NDArray[np.float64]:
    """Numbers as a contiguous array of float64, copied only if necessary. Raises TypeError for complex or masked numbers."""
    if np.iscomplexobj(values):
        raise TypeError(f"{name}: must be real numbers, not complex")
    if np.ma.is_masked(values):
        raise TypeError(f"{name}: must be an array without masked values")
    return np.ascontiguousarray(values, dtype=np.float64)


def _measured(path: str | os.PathLike[str], **options: Any) -> Data:
    """The points of the profile in a file, see `mfv.profiles.read`; its notes are warnings of Python."""
    from . import profiles

    profile = profiles.read(path, **options)
    for note in profile.notes:
        warnings.warn(note, stacklevel=3)
    return {"x": np.ascontiguousarray(profile.x), "height": np.ascontiguousarray(profile.height)}


def _coefficients(x: ArrayLike | None, **coefficients: Coefficient) -> dict[str, Any]:
    """Coefficients as keys or, with their positions, as arrays."""
    if x is None:
        return dict(coefficients)
    return {"data": {"x": _numbers(x, "x"), **{name: _numbers(values, name) for name, values in coefficients.items()}}}


def _same(one: Any, other: Any) -> bool:
    """Whether two values are equal; arrays are compared by element."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_same(one[name], other[name]) for name in one)
    if isinstance(one, KeyGroup) or isinstance(other, KeyGroup):
        return bool(one == other)
    return bool(np.array_equal(one, other))


def _shown(value: Any) -> str:
    """A value in a repr: long arrays by their size."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name!r}: {_shown(item)}" for name, item in value.items()) + "}"
    if isinstance(value, np.ndarray):
        return f"array({'x'.join(map(str, value.shape))})"
    return repr(value)


def created(function: str, *arguments: bytes | c_void_p) -> c_void_p:
    """A handle from one of the functions of the library that create it. Raises InputError."""
    handle, message = c_void_p(), text_buffer()
    status = getattr(library(), function)(*arguments, byref(handle), message, len(message))
    if status != 0:
        raise errors.failure(status, text_of(message))
    return handle


@contextlib.contextmanager
def _scene_handle(text: str, name: str) -> Iterator[c_void_p]:
    """A scene of the library from a text, freed afterwards. Raises InputError."""
    handle = created("mfv_scene_from_text", text_for(text), text_for(name))
    try:
        yield handle
    finally:
        library().mfv_scene_free(byref(handle))


def _text_of_scene(handle: c_void_p) -> str:
    """The library's scene as a namelist text, of any length."""
    return whole_text(library().mfv_scene_text, handle)


def _set_keys(handle: c_void_p, group: str, keys: Mapping[str, Any]) -> list[int]:
    """Set keys; return the statuses. Raises TypeError."""
    return [_set_key(handle, f"{group}%{name}", value) for name, value in keys.items()]


def _set_key(handle: c_void_p, key: str, value: Any) -> int:
    name = text_for(key)
    status: int
    if isinstance(value, (str, os.PathLike)):
        status = library().mfv_scene_set_text(handle, name, text_for(value))
    elif isinstance(value, (bool, np.bool_)):
        status = library().mfv_scene_set_logical(handle, name, int(value))
    elif isinstance(value, numbers.Integral) and abs(int(value)) <= LARGEST_INTEGER:
        status = library().mfv_scene_set_integer(handle, name, int(value))
    elif isinstance(value, numbers.Real):
        status = library().mfv_scene_set_real(handle, name, float(value))
    elif isinstance(value, (Sequence, np.ndarray)):
        values = _numbers(np.atleast_1d(value), key)
        if values.ndim != 1:
            raise ValueError(f"{key} must have one dimension, not the shape {values.shape}")
        status = library().mfv_scene_set_reals(handle, name, real_pointer(values), values.size)
    else:
        raise TypeError(f"{key}: must be a text, a truth value, a number or an array, not {value!r}")
    return status


def _set_data(handle: c_void_p, file: str | os.PathLike[str], dataset: str, values: ArrayLike) -> int:
    """Pass an array to the library in place of one in a file; return the status. Raises ValueError."""
    array = _numbers(values, f"{os.fspath(file)}: {dataset}")
    if array.ndim not in (1, 2) or array.size == 0:
        raise ValueError(f"{os.fspath(file)}: {dataset} must have one or two dimensions, not the shape {array.shape}")
    rows, columns = array.shape if array.ndim == 2 else (array.size, 1)
    status: int = library().mfv_scene_set_data(handle, text_for(file), text_for(dataset), rows, columns, real_pointer(array))
    return status
