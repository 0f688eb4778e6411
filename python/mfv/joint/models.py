"""Reduced models of a joint: springs with sliders in parallel (Iwan), Segalman's distribution, Masing's rules, Bouc and Wen."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .backbone import Backbone

if TYPE_CHECKING:
    from .measurement import Measurement

Array = NDArray[np.float64]

#: First entry of a JSON text, and the version of its layout.
FORMAT, VERSION = "mfv joint", 1

#: Substeps of BoucWen: the largest change of displacement, relative to that at which the first slope reaches the sliding force.
FINEST = 0.02

#: Distance from its slip, relative to displacement and slip, at which a slider of Iwan slides: a zero increment keeps the tangent.
ROUND_OFF = 1.0e-15

#: Keywords of C, and names of the header.
_C_NAMES = (
    "auto break case char const continue default do double else enum extern float for goto if inline int long register restrict "
    "return short signed sizeof static struct switch typedef union unsigned void volatile while alignas alignof asm bool constexpr "
    "false nullptr static_assert thread_local true typeof typeof_unqual "
    "NULL copysign fabs offsetof ptrdiff_t size_t wchar_t mfv_joint mfv_joint_update MFV_JOINT_H"
)

#: The evaluator in C.
_C_HEADER = Path(__file__).with_name("mfv_joint.h")

_Kind = TypeVar("_Kind", bound="_Saved")


class Update(NamedTuple):
    """What a displacement leads to."""

    force: float  #: [force/length]
    #: Consistent tangent, derivative of the force with respect to the displacement, on in the same direction; of Iwan's models a
    #: zero increment keeps it.
    stiffness: float
    state: Array  #: the new state; the old one is unchanged


class Model(Protocol):
    """A model: `update` takes a state to any displacement, so that a trial is undone by not using its state."""

    def start(self) -> Array:
        """The state before the first displacement."""

    def update(self, state: Array, displacement: float) -> Update:
        """Go from a state straight to a `displacement` (in total, not an increment)."""

    def to_json(self) -> str:
        """The model as JSON text, from which `from_json` makes it again with the same digits."""


class _Saved:
    """Parameters of a model as JSON: the fields of its dataclass."""

    NAME: ClassVar[str]

    def __post_init__(self) -> None:
        """Numbers of any kind, such as those of numpy, become Python's. Raises ValueError."""
        for each in fields(self):  # type: ignore[arg-type]
            if each.type == "float":
                object.__setattr__(self, each.name, _number(each.name, getattr(self, each.name)))

    def to_json(self) -> str:
        """The model as JSON text, from which `from_json` makes it again with the same digits."""
        values = {name: np.asarray(value).tolist() for name, value in asdict(self).items()}  # type: ignore[call-overload]
        return json.dumps({"format": FORMAT, "version": VERSION, "model": self.NAME, **values}, indent=1) + "\n"

    @classmethod
    def _of_values(cls: type[_Kind], values: dict[str, Any]) -> _Kind:
        """Raises ValueError if a parameter is missing, unknown or not a number."""
        names = [each.name for each in fields(cls)]  # type: ignore[arg-type]
        if wrong := sorted(set(names) ^ set(values)):
            raise ValueError(
                f"a joint of the model '{cls.NAME}' has the parameters {', '.join(names)}; differing: {', '.join(wrong)}"
            )
        for each in fields(cls):  # type: ignore[arg-type]
            value, is_number = values[each.name], each.type == "float"
            if isinstance(value, list) == is_number or not all(_is_number(item) for item in ([value] if is_number else value)):
                raise ValueError(
                    f"{each.name} of a joint must be {'a number' if is_number else 'a list of numbers'}, not {value!r}"
                )
        return cls(**values)


def _number(name: str, value: Any) -> float:
    """A value of any kind of number, also an array of one, as Python's. Raises ValueError."""
    try:
        number = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        number = np.zeros(0)
    if number.size != 1 or value is None or isinstance(value, (bool, np.bool_, str, bytes)):
        raise ValueError(f"{name} of a joint must be a number, not {value!r}")
    return float(number.reshape(()))


def _is_number(value: Any) -> bool:
    """Whether a value of a JSON text is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


@dataclass(frozen=True, eq=False)
class Iwan(_Saved):
    """Springs with sliders (Jenkins elements) in parallel, and a spring without one (Iwan 1966).

    `stiffness`: of every spring [force/length^2], positive; `slip`: displacement at which its slider begins to slide [length],
    increasing; `elastic`: stiffness of the spring without a slider. The state has the positions of the sliders. Between turning
    points the result does not depend on the number of updates. Raises ValueError.
    """

    stiffness: Array
    slip: Array
    elastic: float = 0.0

    NAME: ClassVar[str] = "iwan"

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("stiffness", "slip"):
            values = np.array(getattr(self, name), dtype=np.float64)
            if values.ndim != 1 or values.size == 0 or not np.all(np.isfinite(values)) or np.any(values <= 0.0):
                raise ValueError(f"{name} of a joint must be positive numbers, one for each slider, at least one")
            values.flags.writeable = False
            object.__setattr__(self, name, values)
        if self.stiffness.shape != self.slip.shape or np.any(np.diff(self.slip) <= 0.0):
            raise ValueError("a joint must have a stiffness for each slip, and the slips must increase")
        if not 0.0 <= self.elastic < np.inf:
            raise ValueError("elastic, the stiffness of a joint without its sliders, must be a number at least 0")

    def start(self) -> Array:
        """All sliders at 0."""
        return np.zeros(self.slip.size)

    def update(self, state: Array, displacement: float) -> Update:
        """Every slider follows once its spring is stretched by its slip; exact for any displacement."""
        sliders = np.clip(state, displacement - self.slip, displacement + self.slip)
        force = self.stiffness @ (displacement - sliders) + self.elastic * displacement
        round_off = ROUND_OFF * (abs(displacement) + self.slip)
        stuck = np.abs(displacement - state) < self.slip - round_off
        return Update(float(force), float(self.stiffness @ stuck + self.elastic), sliders)

    def force(self, displacement: ArrayLike) -> Array:
        """Force of first loading, the backbone, at displacements of any shape."""
        u = np.asarray(displacement, dtype=np.float64)
        return np.asarray(np.clip(u[..., None], -self.slip, self.slip) @ self.stiffness + self.elastic * u)

    def dissipation(self, amplitude: ArrayLike) -> Array:
        """Energy of a cycle between -amplitude and +amplitude [force]: 4 k phi (amplitude - phi) of every slider that slides."""
        slid = np.maximum(np.asarray(amplitude, dtype=np.float64)[..., None] - self.slip, 0.0)
        return np.asarray(4.0 * slid @ (self.stiffness * self.slip))

    def c_source(self, name: str = "joint", measured: Measurement | None = None) -> str:
        """The joint as a C header that needs no other file: an evaluator without allocation, and the constant `name`.

        `measured`: what it was fitted to, for a comment with case, units, amplitudes and warnings. Raises
        ValueError if the name is not one of C, or has a meaning there or in the header.
        """
        if not (name.isidentifier() and name.isascii()):
            raise ValueError(f"{name!r} is not a name in C")
        if name in _C_NAMES.split() or name.startswith("_"):
            raise ValueError(f"{name!r} is reserved in C or in the header; choose another name")
        arrays = [
            f"static const double {name}_{what}[] = {{{', '.join(map(repr, values.tolist()))}}};"
            for what, values in (("stiffness", self.stiffness), ("slip", self.slip))
        ]
        made = f"static const mfv_joint {name} = {{{self.slip.size}, {name}_stiffness, {name}_slip, {self.elastic!r}}};"
        return "\n".join([_C_HEADER.read_text(), *_comment(measured), *arrays, made, ""])


def _comment(measured: Measurement | None) -> list[str]:
    """A comment in C about a measurement: its source, the amplitudes of its cycles, and its warnings."""
    if measured is None:
        return []
    amplitudes = [cycle.amplitude for cycle in measured.cycles]
    known = f"amplitudes from {min(amplitudes):.4g} to {max(amplitudes):.4g}, backbone to {measured.backbone.displacement[-1]:.4g}"
    lines = [measured.source, known, *(f"warning: {text}" for text in measured.warnings)]
    return [f"/* {line.replace('*/', '* /')} */" for line in lines if line]


@dataclass(frozen=True)
class Segalman(_Saved):
    """Segalman's four-parameter Iwan model (2005): density R phi^chi up to phi_max, and a concentrated part S at phi_max.

    `sliding_force` F_S, `stiffness` K_T at small displacements, `chi` above -1 (the dissipation grows with the amplitude to the
    3 + chi), `beta` at least 0, ratio of the concentrated to the distributed stiffness. The equations of F_S, K_T, R, S and
    phi_max follow from force and stiffness as moments of the density. `iwan` makes the element of it. Raises ValueError.
    """

    sliding_force: float
    stiffness: float
    chi: float
    beta: float

    NAME: ClassVar[str] = "segalman"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not (self.sliding_force > 0.0 and self.stiffness > 0.0 and self.chi > -1.0 and self.beta >= 0.0):
            raise ValueError("Segalman's model needs sliding_force and stiffness above 0, chi above -1 and beta at least 0")

    @property
    def _share(self) -> float:
        """Mean slip of the distributed sliders over phi_max, plus beta."""
        return self.beta + (self.chi + 1.0) / (self.chi + 2.0)

    @property
    def largest_slip(self) -> float:
        """phi_max, where all slides: F_S (1 + beta)/(K_T (beta + (chi + 1)/(chi + 2)))."""
        return float(self.sliding_force * (1.0 + self.beta) / (self.stiffness * self._share))

    @property
    def coefficient(self) -> float:
        """R of the density R phi^chi."""
        return float(self.sliding_force * (self.chi + 1.0) / (self._share * self.largest_slip ** (self.chi + 2.0)))

    @property
    def concentrated(self) -> float:
        """S, the stiffness that slides at phi_max."""
        return self.sliding_force / self.largest_slip * self.beta / self._share

    def force(self, displacement: ArrayLike) -> Array:
        """Force of first loading: K_T u - R u^(chi + 2)/((chi + 1)(chi + 2)) up to phi_max, then F_S."""
        u = np.asarray(displacement, dtype=np.float64)
        reached = np.minimum(np.abs(u), self.largest_slip)
        bent = self.coefficient * reached ** (self.chi + 2.0) / ((self.chi + 1.0) * (self.chi + 2.0))
        return np.asarray(np.sign(u) * (self.stiffness * reached - bent))

    def dissipation(self, amplitude: ArrayLike) -> Array:
        """Energy of a cycle: 4 R u^(chi + 3)/((chi + 2)(chi + 3)) up to phi_max, beyond it with 4 F_S for each further length."""
        u = np.abs(np.asarray(amplitude, dtype=np.float64))
        reached = np.minimum(u, self.largest_slip)
        microslip = 4.0 * self.coefficient * reached ** (self.chi + 3.0) / ((self.chi + 2.0) * (self.chi + 3.0))
        return np.asarray(microslip + 4.0 * self.sliding_force * (u - reached))

    def iwan(self, cells: int = 20, smallest: float = 1.0e-3) -> Iwan:
        """The element: two sliders for each of the `cells`, whose edges grow geometrically from `smallest` times phi_max.

        At the edges force, stiffness and dissipation are exact (see `gauss_pair`). One cell goes up to phi_max. Raises ValueError.
        """
        if not 0.0 < smallest < 1.0:
            raise ValueError(f"smallest={smallest}: must be between 0 and 1, a part of phi_max")
        top = self.largest_slip
        edges = np.append(0.0, top * np.geomspace(1.0, smallest, number_of_cells(cells))[::-1])
        pieces = []
        for low, high in zip(edges[:-1], edges[1:]):
            powers = self.chi + 1.0 + np.arange(4)
            total, first, second, third = self.coefficient * (high**powers - low**powers) / powers
            mean, square, cube = first / total, second / total, third / total
            pieces.append(_pair(total, mean, square - mean**2, cube - 3.0 * mean * square + 2.0 * mean**3))
        slip, stiffness = (np.concatenate(values) for values in zip(*pieces))
        if self.beta > 0.0:
            slip, stiffness = np.append(slip, top), np.append(stiffness, self.concentrated)
        return Iwan(stiffness, slip)

    def start(self) -> Array:
        """The state of `iwan()`."""
        return self._element.start()

    def update(self, state: Array, displacement: float) -> Update:
        """That of `iwan()`, which is made at the first update."""
        return self._element.update(state, displacement)

    @cached_property
    def _element(self) -> Iwan:
        return self.iwan()


def number_of_cells(cells: Any) -> int:
    """The number of cells of an Iwan model. Raises ValueError."""
    try:
        count = index(cells)
    except TypeError:
        count = 0
    if count < 1:
        raise ValueError(f"cells={cells}: must be a whole number of at least 1")
    return count


def gauss_pair(slip: Array, stiffness: Array) -> tuple[Array, Array]:
    """Two sliders, or fewer, with the moments 0 to 3 of many: their slips, increasing, and their stiffnesses.

    Gauss quadrature of the measure (Golub and Welsch 1969): slips lie between those of the many, stiffnesses are positive. Where
    all of the many slide, force (moment 1), stiffness (0) and dissipation (1 and 2) are theirs.
    """
    total = float(stiffness.sum())
    mean = float(stiffness @ slip) / total
    off = slip - mean
    return _pair(total, mean, float(stiffness @ off**2) / total, float(stiffness @ off**3) / total)


def _pair(total: float, mean: float, variance: float, third: float) -> tuple[Array, Array]:
    """Two sliders with the stiffness `total` and these central moments of the slip; one if they are as good as equal."""
    if variance <= (1.0e-7 * mean) ** 2:
        return np.array([mean]), np.array([total])
    spread = np.sqrt(variance)
    slips, vectors = np.linalg.eigh([[mean, spread], [spread, mean + third / variance]])
    return slips, total * vectors[0] ** 2


@dataclass(frozen=True, eq=False)
class Masing(_Saved):
    """Masing's rules with memory of turning points, on a backbone, linear between its points and beyond the last.

    A branch after a turning point is the backbone scaled by two, and a closed inner loop is forgotten (Masing
    1926). The backbone need not be concave. The state has the present point and then the turning points, a row for each with
    displacement and force. Raises ValueError as `Backbone.of`.
    """

    displacement: Array
    force: Array

    NAME: ClassVar[str] = "masing"

    def __post_init__(self) -> None:
        backbone = Backbone.of(self.displacement, self.force)
        object.__setattr__(self, "displacement", backbone.displacement)
        object.__setattr__(self, "force", backbone.force)

    @cached_property
    def _slopes(self) -> Array:
        return Backbone(self.displacement, self.force).stiffness

    @classmethod
    def of(cls, backbone: Backbone) -> Masing:
        """The model with a backbone. Raises ValueError if it is in doubt."""
        backbone.trusted()
        return cls(backbone.displacement, backbone.force)

    def start(self) -> Array:
        """The unloaded point, no turning points."""
        return np.zeros((1, 2))

    def update(self, state: Array, displacement: float) -> Update:
        """Follow the branch, and the next outer one where its loop closes."""
        turns: list[tuple[float, float]] = [(float(u), float(q)) for u, q in state[1:]]
        at = float(state[0, 0])
        came_from = turns[-1][0] if turns else 0.0
        if (displacement - at) * (at - came_from) < 0.0:
            turns.append((at, float(state[0, 1])))
        while turns and abs(displacement - turns[-1][0]) >= _range_of_branch(turns):
            del turns[-2:]
        force, stiffness = self._on_branch(turns, displacement)
        return Update(force, stiffness, np.array([(displacement, force), *turns]))

    def _on_branch(self, turns: list[tuple[float, float]], displacement: float) -> tuple[float, float]:
        """Force and stiffness on the branch after the last turning point; without one, of first loading."""
        u, q, scale = (*turns[-1], 2.0) if turns else (0.0, 0.0, 1.0)
        reached = abs(displacement - u) / scale
        i = min(int(np.searchsorted(self.displacement, reached, side="right")), self.displacement.size - 1) - 1
        slope = float(self._slopes[i])
        force = float(self.force[i]) + slope * (reached - float(self.displacement[i]))
        return q + scale * float(np.sign(displacement - u)) * force, slope


def _range_of_branch(turns: list[tuple[float, float]]) -> float:
    """Displacement from the last turning point at which its branch meets an outer one."""
    return abs(turns[-1][0] - turns[-2][0]) if len(turns) > 1 else 2.0 * abs(turns[-1][0])


@dataclass(frozen=True)
class BoucWen(_Saved):
    """The model of Bouc (1967) and Wen (1976): Q = elastic u + sliding_force z, with

        dz/du = stiffness/sliding_force (1 - |z|^exponent (shape sgn(z du) + 1 - shape)).

    In Wen's symbols with A = 1 the shape is beta/(beta + gamma); thermodynamically admissible from 1/2 on (Erlicher and Point
    2004). `stiffness` is that at u = 0 without `elastic` [force/length^2]. The state has u and z. Integrated by the fourth-order
    method of Runge and Kutta. Raises ValueError.
    """

    stiffness: float
    sliding_force: float
    exponent: float
    shape: float
    elastic: float = 0.0

    NAME: ClassVar[str] = "bouc_wen"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not (
            self.stiffness > 0.0 and self.sliding_force > 0.0 and self.exponent > 0.0 and self.shape >= 0.5 and self.elastic >= 0.0
        ):
            raise ValueError(
                "Bouc and Wen's model needs stiffness, sliding_force and exponent above 0, shape at least 0.5, elastic at least 0"
            )

    def start(self) -> Array:
        """u = z = 0."""
        return np.zeros(2)

    def update(self, state: Array, displacement: float) -> Update:
        """Integrate over the displacement."""
        u, z = map(float, state)
        left = (displacement - u) * self.stiffness / self.sliding_force
        direction = math.copysign(1.0, left)
        while left != 0.0:
            h = direction * min(abs(left), FINEST)  # steps of one size but for the last: the force is continuous
            k1 = self._rate(z, direction)
            k2 = self._rate(z + 0.5 * h * k1, direction)
            k3 = self._rate(z + 0.5 * h * k2, direction)
            z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + self._rate(z + h * k3, direction))
            left = left - h if abs(left) > FINEST else 0.0
        tangent = self.elastic + self.stiffness * self._rate(z, direction)
        return Update(self.elastic * displacement + self.sliding_force * z, tangent, np.array([displacement, z]))

    def _rate(self, z: float, direction: float) -> float:
        """dz/du over stiffness/sliding_force."""
        factor = 1.0 if z * direction >= 0.0 else 1.0 - 2.0 * self.shape
        return float(1.0 - factor * min(abs(z), 1.0) ** self.exponent)

    def cycles(self, points: int = 4000) -> tuple[Array, Array, Array]:
        """Steady cycles between -u and +u: amplitudes u, increasing, forces at u, and energies dissipated.

        A half of a cycle unloads from z_a to 0 and loads to -z_a, so that u is half the sum of the integrals over z from 0 to z_a
        of 1/(1 + (2 shape - 1) z^n) and of 1/(1 - z^n); the energy is twice the difference of the first moments of the latter and
        the former. Integrated by the trapezoidal rule, points equally spaced in ln(z/(1 - z)).
        """
        z = np.append(0.0, 1.0 / (1.0 + np.exp(-np.linspace(-16.0, 20.0, points - 1))))
        unloads, loads = 1.0 / (1.0 + (2.0 * self.shape - 1.0) * z**self.exponent), 1.0 / (1.0 - z**self.exponent)
        length = self.sliding_force / self.stiffness
        amplitude = 0.5 * length * _integrals(unloads + loads, z)
        energy = 2.0 * self.sliding_force * length * _integrals((loads - unloads) * z, z)
        return amplitude, self.elastic * amplitude + self.sliding_force * z, energy


def _integrals(y: Array, x: Array) -> Array:
    """Integrals of y from the first x to each x, trapezoidal rule."""
    return np.append(0.0, np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x)))


#: The models by their name in JSON.
_MODELS: dict[str, type[Iwan] | type[Segalman] | type[Masing] | type[BoucWen]] = {
    kind.NAME: kind for kind in (Iwan, Segalman, Masing, BoucWen)
}


def from_json(text: str) -> Iwan | Segalman | Masing | BoucWen:
    """The model of a text of `to_json`. Raises ValueError with what is wrong."""
    try:
        values = json.loads(text)
    except RecursionError:
        raise ValueError("not the JSON text of a joint: too many brackets inside each other") from None
    except ValueError as error:
        raise ValueError(f"not the JSON text of a joint: {error}") from None
    if not isinstance(values, dict) or values.pop("format", None) != FORMAT:
        raise ValueError(f'not the JSON text of a joint: "format" is not "{FORMAT}"')
    if (version := values.pop("version", None)) != VERSION:
        raise ValueError(f"a joint of version {version!r}; this package reads version {VERSION}")
    if not isinstance(name := values.pop("model", None), str) or name not in _MODELS:
        raise ValueError(f"unknown joint model {name!r}; there are {', '.join(_MODELS)}")
    return _MODELS[name]._of_values(values)
