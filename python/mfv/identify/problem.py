"""Residuals of loops as a function of the unknowns."""

from __future__ import annotations

import copy
import difflib
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._datum import datums_of, with_datums
from .._packages import needed
from ..errors import MfvError, input_error
from ..scene import Output, Scene, Solver, Step
from ..studies.axes import Axis
from .estimate import UNDETERMINED, Estimate
from .loop import Loop
from .path import Path
from .priors import NAMES, Priors, RigError

if TYPE_CHECKING:
    from ..case import Case

Array = NDArray[np.float64]

#: The parameter that is no key of the scene: stiffness of the rig, in series with the contact [force/length^2].
RIG_STIFFNESS = "rig_stiffness"

#: Annotations of keys whose values are real numbers.
_REAL = ("float", "float | None", "Coefficient | None")

#: Half the step of the central differences, in the logarithm of a parameter (docs/identify.md has the measurements).
_DIFFERENCE = 0.05

#: Two parameters with a larger correlation than this are reported as not separated.
_CORRELATED = 0.98

#: Logarithm of the factor beyond which a parameter has no limit.
_FARTHEST_LIMIT = 8.0

#: Largest factor between a parameter and its start value.
_FARTHEST = 1.0e4

#: Rows that a loop needs for its systematic errors to be unknowns.
LEAST_ROWS = 20

#: Rows of a record with a lag that are nearer than this to its ends are not used [cycles].
EDGE = 0.01

#: Half the steps of the central differences in the systematic errors.
_STEPS = {"lag": 0.1, "drift": 1e-3, "offset": 0.01, "slack": 2e-3}

#: The systematic errors whose effect is reported: how much of them, and its name.
SMALL = {"lag": (0.1, "0.1 degrees of lag"), "drift": (0.001, "0.1 % of drift")}

#: Residual of rows that the model cannot reach since it slides, in ranges of the column.
_UNREACHED = 10.0


class Places(NamedTuple):
    """Places of the unknowns of a loop: the origin of its shift, its systematic errors in the order of NAMES, its levels."""

    origin: int
    errors: dict[str, int]
    levels: slice


class Problem:
    """Residuals of loops as a function of the unknowns.

    These are the logarithms of the parameters, then for every loop the origin of its shift over the range of the shift, its
    systematic errors in the units of `Priors`, and the levels of a noisy driven column as deviations from their estimates over their
    standard errors. Unknowns that are not `active` stay 0.
    """

    def __init__(
        self,
        scene: Scene,
        loops: list[Loop],
        paths: list[Path],
        free: Mapping[str, float | Axis],
        rig_stiffness: float,
        priors: Priors,
    ) -> None:
        """Raises InputError."""
        if not free or not loops:
            raise input_error("give at least one loop and one free parameter such as {'friction%mu': 0.5}")
        pressed = copy.copy(scene)
        pressed.steps = [*scene.steps, Step(normal_force=max(loop.normal_force for loop in loops))]
        #: Default datums of wedges and power laws, which otherwise would be those of the normal force of every loop.
        self.datums = datums_of(pressed)
        self.scene, self.loops, self.rig_stiffness = with_datums(scene, self.datums), loops, rig_stiffness
        self.axes = {name: value if isinstance(value, Axis) else Axis(name, [value]) for name, value in free.items()}
        self.names = list(free)
        self.start_values = np.array([_start(name, axis) for name, axis in self.axes.items()])
        self.paths = paths
        #: Ranges of the columns without spikes.
        self.force_ranges, self.ranges = (
            [max(float(np.ptp(column[~path.is_spike])), 1e-300) for column, path in zip(columns, paths)]
            for columns in ([loop.tangential_force for loop in loops], [loop.shift for loop in loops])
        )
        self.is_used = [~path.is_spike for path in paths]
        self.noise_is_given = False
        #: Factor of the variances of the noise.
        self.scale = 1.0
        #: How the model ended before the last row at the last values with which it did.
        self.early_end = ""
        self._known: dict[tuple[Any, ...], list[Array] | None] = {}
        place = len(self.names)
        self.places: list[Places] = []
        active, widths = [True] * place, [math.inf] * place
        for loop, path in zip(loops, paths):
            count = path.levels.size if path.errors.any() else 0
            errors = {name: place + 1 + number for number, name in enumerate(NAMES)}
            first = place + 1 + len(NAMES)
            self.places.append(Places(place, errors, slice(first, first + count)))
            place = first + count
            # Both directions, and enough rows: otherwise the prior would only be handed through.
            is_determined = loop.shift.size >= LEAST_ROWS and len(path.turns) > 1
            given = [float(getattr(priors, name)) if is_determined else 0.0 for name in NAMES]
            if loop.drive == "tangential_force" and loop.cycles_before > 0:
                # Cycles in partial slip depend on the range of the force alone.
                given[NAMES.index("offset")] = 0.0
            if given[NAMES.index("lag")] > 0.0:
                # A lag takes them to before the record, where the branch is another one.
                self.is_used[len(self.places) - 1] &= (path.time - path.time[0] >= EDGE) & (path.time[-1] - path.time >= EDGE)
            active += [True, *(width > 0.0 for width in given), *[True] * count]
            # After sliding to both sides the contact does not depend on the origin of a prescribed shift; it is known to the range.
            widths += [1.0 if loop.drive == "shift" else math.inf, *given, *[1.0] * count]
        self.count = place
        self.active, self.widths = np.array(active), np.array(widths)
        self._scene_for(self.start_values, loops[0])

    def start(self) -> Array:
        """The unknowns at the start values; the origins of the shift from the means of rows and model."""
        x = np.zeros(self.count)
        x[: len(self.names)] = np.log(self.start_values)
        for number, loop in enumerate(self.loops):
            origin = self.places[number].origin
            if loop.drive == "tangential_force" and (branches := self.curves(x, number)):
                x[origin] = np.mean(loop.shift - self._interpolated(loop, branches, number)) / self.ranges[number]
            elif loop.drive == "shift":
                x[origin] = self._middle(number)
        return x

    def _middle(self, number: int) -> float:
        """About the origin of a prescribed shift, over its range: the middle of cycles, or where the first loading begins."""
        path, loop = self.paths[number], self.loops[number]
        middle = 0.5 * (path.levels.max() + path.levels.min()) if path.before else loop.shift[0]
        return float(middle) / self.ranges[number]

    def residuals(self, x: Array) -> Array:
        """All residuals: those of the rows that are used, then the deviations of active unknowns from what is known before."""
        parts = [self.distances(x, number)[self.is_used[number]] for number in range(len(self.loops))]
        rows = np.concatenate(parts) / math.sqrt(self.scale)
        return np.concatenate([rows, *self._deviations(x)])

    def _deviations(self, x: Array) -> list[Array]:
        expected = np.zeros(self.count)
        noisy = np.zeros(self.count, dtype=bool)
        for number, (loop, places) in enumerate(zip(self.loops, self.places)):
            expected[places.origin] = self._middle(number) if loop.drive == "shift" else 0.0
            noisy[places.levels] = True
        known = self.active & np.isfinite(self.widths)
        widths = np.where(noisy, math.sqrt(self.scale), 1.0) * self.widths
        return [(x - expected)[known] / widths[known]]

    def jacobian(self, x: Array, places: NDArray[np.int64] | None = None) -> Array:
        """Central differences with respect to the active unknowns, or to those at the places; one-sided where the other side slides."""
        here = self.residuals(x)
        columns = []
        for place in np.flatnonzero(self.active) if places is None else places:
            step = np.zeros(x.size)
            step[place] = self._step(int(place))
            ahead, behind = ((x + sign * step if self.reaches(x + sign * step) else x) for sign in (1.0, -1.0))
            distance = ahead[place] - behind[place]
            columns.append((self.residuals(ahead) - self.residuals(behind)) / distance if distance > 0.0 else np.zeros(here.size))
        return np.stack(columns, axis=1)

    def _step(self, place: int) -> float:
        """Half the step of a central difference."""
        if place < len(self.names):
            return _DIFFERENCE
        for each in self.places:
            if place == each.origin:
                return 1e-3
            for name, at in each.errors.items():
                if place == at:
                    return _STEPS[name]
        return 0.5

    def solve(self, start: Array) -> Any:
        """Least squares from a start; `x` and `jac` of what scipy returns are of all and of the active unknowns."""
        x = start.copy()

        def whole(active: Array) -> Array:
            x[self.active] = active
            return x

        found = needed("scipy.optimize").least_squares(
            lambda active: self.residuals(whole(active)),
            start[self.active],
            jac=lambda active: self.jacobian(whole(active)),
            x_scale="jac",
            xtol=1e-5,
            ftol=1e-7,
            max_nfev=60,
        )
        found.x = whole(found.x).copy()
        return found

    def reaches(self, x: Array) -> bool:
        """Whether the model reaches all rows; it does not with gross sliding under a prescribed force."""
        return all(self.curves(x, number) is not None for number in range(len(self.loops)))

    def distances(self, x: Array, number: int) -> Array:
        """Residuals of the rows of a loop: signed distances from the branch of the model in the plane of the columns, each over its
        standard deviation; vertical ones if the driven column is exact."""
        loop = self.loops[number]
        force_noise, shift_noise = loop.force_noise or 0.0, loop.shift_noise or 0.0
        branches = self.curves(x, number)
        if branches is None:
            column, noise = (loop.shift, shift_noise) if loop.drive == "tangential_force" else (loop.tangential_force, force_noise)
            return np.full(column.size, _UNREACHED * np.ptp(column) / noise)
        result = np.empty(loop.shift.size)
        all_forces, all_shifts, on = self.corrected(x, number)
        for branch, points in enumerate(branches):
            rows = on == branch
            force, shift = all_forces[rows], all_shifts[rows]
            if loop.drive == "tangential_force" and force_noise == 0.0:
                result[rows] = (shift - _extended(force, points[0], points[1])) / shift_noise
            elif loop.drive == "shift" and shift_noise == 0.0:
                result[rows] = (_extended(shift, points[1], points[0]) - force) / force_noise
            else:
                scales = np.array([[force_noise or 1e-9 * np.ptp(points[0])], [shift_noise or 1e-9 * np.ptp(points[1])]])
                result[rows] = _signed_distance(np.stack([force, shift]) / scales, points / scales)
        return result

    def corrected(self, x: Array, number: int) -> tuple[Array, Array, NDArray[np.int64]]:
        """Force and shift of the rows without lag, drift and offset, and the branch of every row.

        A shift that lags belongs to the force of an earlier time, and a force to the shift of a later one: the driven column is
        displaced along its own path.
        """
        loop, path = self.loops[number], self.paths[number]
        lag, drift, offset = (x[self.places[number].errors[name]] for name in ("lag", "drift", "offset"))
        by_force = loop.drive == "tangential_force"
        change, branch = path.displaced((-lag if by_force else lag) / 360.0)
        force = loop.tangential_force - 0.5 * offset * self.force_ranges[number]
        shift = loop.shift - 0.5 * drift * self.ranges[number] * path.time
        return (force + change, shift, branch) if by_force else (force, shift + change, branch)

    def response(self, x: Array, number: int) -> Array | None:
        """The column of a loop that is not driven, by the model; None if it ends early."""
        branches = self.curves(x, number)
        return None if branches is None else self._interpolated(self.loops[number], branches, number)

    def _interpolated(self, loop: Loop, branches: list[Array], number: int) -> Array:
        result = np.empty(loop.shift.size)
        for branch, points in enumerate(branches):
            rows = self.paths[number].branch == branch
            driven, other = (0, 1) if loop.drive == "tangential_force" else (1, 0)
            result[rows] = _extended(loop._driven[rows], points[driven], points[other])
        return result

    def curves(self, x: Array, number: int) -> list[Array] | None:
        """The branches of a loop by the model, arrays (2, n) of tangential force and measured shift; None if it ends early."""
        loop, path, places = self.loops[number], self.paths[number], self.places[number]
        origin = x[places.origin] * self.ranges[number]
        drift, offset, slack = (x[places.errors[name]] for name in ("drift", "offset", "slack"))
        play = 0.5 * slack * self.ranges[number]
        steps = x[: len(self.names)] - np.log(self.start_values)
        if np.max(np.abs(steps)) > math.log(_FARTHEST):
            self.early_end = f"{self.names[int(np.argmax(np.abs(steps)))]} is far from its start value"
            return None
        values = np.exp(x[: len(self.names)])
        targets = path.levels + path.errors * x[places.levels] if path.errors.any() else path.levels
        rig = values[self.names.index(RIG_STIFFNESS)] if RIG_STIFFNESS in self.names else self.rig_stiffness
        of_scene = [value for name, value in zip(self.names, values) if name != RIG_STIFFNESS]
        if loop.drive == "tangential_force":
            targets = targets - 0.5 * offset * self.force_ranges[number]
        else:
            targets = targets - origin - 0.5 * drift * self.ranges[number] * path.level_times
            targets = targets - 0.5 * play * np.sign(path.levels - 0.5 * (path.levels.max() + path.levels.min()))
        # With a prescribed force, the stiffness of the rig does not change the state of the contact.
        key = (number, *of_scene, *targets, *([rig] if loop.drive == "shift" else []))
        if key not in self._known:
            if len(self._known) > 2000:
                self._known.clear()
            self._known[key] = self._solved(
                values, loop, [float(targets[n]) for n in [*path.before, *path.turns]], rig, len(path.turns)
            )
        contact = self._known[key]
        if contact is None:
            return None
        rigs = [np.stack([force, shift + force / rig + origin]) for force, shift in contact]
        return rigs if play == 0.0 else [_with_play(points, play, self.force_ranges[number]) for points in rigs]

    def _scene_for(self, values: Array, loop: Loop) -> Scene:
        """The scene with values of the parameters, pressed with the force of a loop. Raises InputError."""
        scene = copy.copy(self.scene)
        for part in ("lower", "upper", "friction", "mesh", "solver"):
            setattr(scene, part, copy.copy(getattr(scene, part)))
        scene.solver = scene.solver or Solver()
        if scene.solver.algorithm != "conventional":
            scene.solver.accuracy, scene.solver.stepping = None, "event"  # rows are interpolated between events
        scene.steps = [Step(normal_force=loop.normal_force, friction=loop.pressed_with_friction)]
        scene.output = Output(history="events", states="none")
        parts: dict[str, Any] = dict(scene._parts())
        for axis, value in zip(self.axes.values(), values):
            keys = [axis.keys] if isinstance(axis.keys, str) else list(axis.keys)
            for key, factor in zip(keys, axis.factors or [1.0] * len(keys)):
                group, _, name = key.partition("%")
                if key == RIG_STIFFNESS:
                    continue
                if group not in parts or group.startswith("step"):
                    raise input_error(
                        f"'{key}': no such parameter; free are keys of bodies, friction and mesh, and {RIG_STIFFNESS}"
                        + _proposal(key, parts)
                    )
                if parts[group]._group().__annotations__.get(name, "float") not in _REAL:
                    raise input_error(f"'{key}': cannot be estimated, since its values are not real numbers")
                try:
                    setattr(parts[group], name, float(value) * factor)
                except AttributeError as error:
                    raise input_error(f"'{key}': {error}") from None
        return scene

    def _solved(self, values: Array, loop: Loop, targets: list[float], rig: float, count: int) -> list[Array] | None:
        """Tangential force and shift of the contact along the last `count` branches to the targets; None if it ends early."""
        try:
            contact = self._scene_for(values, loop).contact()
        except MfvError as error:  # the least squares may try a value that is not permitted
            self.early_end = f"{loop.name}: {error}"
            return None
        with contact:
            contact.run()
            for target in targets:
                if loop.drive == "tangential_force":
                    contact.advance(tangential_force=target)
                else:
                    _advance_with_rig(contact, target, rig)
            if contact.outcome != "complete":  # it stays after an early end
                self.early_end = f"{loop.name}: {contact.message}"
                return None
            step = contact["history/step"]
            rows = np.stack([contact["history/tangential_force"], contact["history/shift"]])
        last = int(step[-1])
        ends = np.searchsorted(step, np.arange(last - count, last + 1), side="right")
        return [rows[:, ends[n] - 1 : ends[n + 1]] for n in range(count)]

    def standard_errors(self, x: Array) -> Array:
        """Standard errors of all active unknowns."""
        jacobian = self.jacobian(x)
        return np.asarray(np.sqrt(np.diag(_inverse_information(jacobian)[0])))

    def estimate(self, x: Array, jacobian: Array) -> Estimate:
        """The estimate at the unknowns from the derivatives with respect to the active ones."""
        covariance, lost = _inverse_information(jacobian)
        count = len(self.names)
        values = np.exp(x[:count])
        relative = covariance[:count, :count]
        spread = np.zeros(self.count)
        spread[self.active] = np.sqrt(np.diag(covariance))
        estimate = Estimate(
            self.names,
            dict(zip(self.names, values.tolist())),
            relative * np.outer(values, values),
            max(jacobian.shape[0] - jacobian.shape[1], 1),
            [],
            [
                RigError(loop.name, name, float(x[place]), float(spread[place]), bool(spread[place] < 0.9 * self.widths[place]))
                for loop, places in zip(self.loops, self.places)
                for name, place in places.errors.items()
                if self.active[place]
            ],
            self._sensitivities(x, jacobian),
        )
        known: dict[tuple[str, float], dict[str, tuple[float, float]]] = {}

        def profile(name: str, quantile: float) -> dict[str, tuple[float, float]]:
            if (name, quantile) not in known:
                known[name, quantile] = self.profile(x, jacobian, name, quantile)
            return known[name, quantile]

        estimate._profile = profile
        if self.datums:
            estimate.warnings.append(
                f"the datum of the displacements, {max(self.datums.values()):.4g}, is the default for the largest normal force of the "
                f"scene and its loops: {RIG_STIFFNESS} is valid with it only; give datum to compare with other fits"
            )
        estimate.warnings += self._undetermined(estimate, np.sqrt(np.diag(relative)), lost[:count])
        return estimate

    def profile(self, x: Array, jacobian: Array, name: str, quantile: float) -> dict[str, tuple[float, float]]:
        """Values of a parameter at which chi-squared, least with respect to the other unknowns, is larger by the square of a quantile
        than at the estimate, and the other parameters there. The others are linear, as at the estimate; limits beyond a factor of
        3000 are 0 and infinity.
        """
        place = self.names.index(name)
        rest = np.delete(jacobian, place, axis=1)
        inverse = np.linalg.pinv(rest, rcond=1e-7)
        others = [other for other in self.names if other != name]

        def moved(step: float) -> tuple[float, Array]:
            """Chi-squared and changes of the others."""
            there = x.copy()
            there[place] += step
            if not self.reaches(there):
                return math.inf, np.zeros(rest.shape[1])
            residuals = self.residuals(there)
            change = -inverse @ residuals
            left = residuals + rest @ change
            return float(left @ left), change

        limit = moved(0.0)[0] + quantile**2
        limits, ends = [], []
        for sign, beyond in ((-1.0, 0.0), (1.0, math.inf)):
            inside, outside = 0.0, 0.125
            while outside < _FARTHEST_LIMIT and moved(sign * outside)[0] < limit:
                inside, outside = outside, 2.0 * outside
            is_free = outside >= _FARTHEST_LIMIT and moved(sign * outside)[0] < limit
            for _ in range(0 if is_free else 6):
                middle = 0.5 * (inside + outside)
                inside, outside = (inside, middle) if moved(sign * middle)[0] >= limit else (middle, outside)
            limits.append(beyond if is_free else float(math.exp(x[place] + sign * 0.5 * (inside + outside))))
            ends.append(moved(sign * inside)[1])
        result = {name: (limits[0], limits[1])}
        for number, other in enumerate(others):
            values = [math.exp(x[self.names.index(other)] + min(max(float(end[number]), -7.0), 7.0)) for end in ends]
            result[other] = (min(values), max(values))
        return result

    def _sensitivities(self, x: Array, jacobian: Array) -> dict[str, dict[str, float]]:
        """Relative changes of the parameters by a small lag and by a small drift of all loops, if neither were an unknown."""
        rows = sum(int(used.sum()) for used in self.is_used)
        kept = [
            column
            for column, place in enumerate(np.flatnonzero(self.active))
            if not any(place in (places.errors["lag"], places.errors["drift"]) for places in self.places)
        ]
        # Without the rows of their priors, which are zero in the columns that are left.
        inverse = np.linalg.pinv(jacobian[:, kept], rcond=1e-7)[: len(self.names)]
        result = {}
        for name, (amount, label) in SMALL.items():
            effect = np.zeros(jacobian.shape[0])
            for places in self.places:
                change = self.jacobian(x, np.array([places.errors[name]]))[:, 0]
                effect[:rows] += amount * change[:rows]
            result[label] = dict(zip(self.names, np.expm1(inverse @ effect).tolist()))
        return result

    def score(self, x: Array, jacobian: Array, name: str, number: int) -> tuple[float, float]:
        """A systematic error that is not an unknown, as one step of the fit would find it, and its standard error (a score test, Rao
        1948)."""
        place = self.places[number].errors[name]
        rows = sum(int(used.sum()) for used in self.is_used)
        column = self.jacobian(x, np.array([place]))[:, 0]
        column[rows:] = 0.0
        rest = column - jacobian @ np.linalg.lstsq(jacobian, column, rcond=1e-7)[0]
        information = float(rest @ rest)
        if information < 1e-9 * float(column @ column) or information == 0.0:
            return 0.0, math.inf
        return -float(rest @ self.residuals(x)) / information, 1.0 / math.sqrt(information)

    def _undetermined(self, estimate: Estimate, relative: Array, lost: NDArray[np.bool_]) -> list[str]:
        """Sentences about what the loops do not determine."""
        sentences = []
        for name, error, is_lost in zip(self.names, relative, lost):
            if is_lost or not error <= UNDETERMINED:
                low, high = estimate.interval(name)
                why = (
                    "the loops do not depend on it separately"
                    if is_lost
                    else f"95 % interval from {low:.3g} " + ("on" if math.isinf(high) else f"to {high:.3g}")
                )
                sentences.append(f"{name} is not determined ({why}){self._advice(name, estimate.values)}")
        for i, name in enumerate(self.names):
            for j, other in enumerate(self.names[:i]):
                if abs(estimate.correlation[i, j]) > _CORRELATED:
                    sentences.append(
                        f"{other} and {name} are not separated (correlation {estimate.correlation[i, j]:.3f}): "
                        "fix one of them, or add a test that changes their effect differently"
                    )
        return sentences

    def _advice(self, name: str, values: Mapping[str, float]) -> str:
        """What would determine a coefficient of friction."""
        if name not in ("friction%mu", "friction%mu_static"):
            return ""
        ratio = max(np.max(np.abs(loop.tangential_force)) / loop.normal_force for loop in self.loops) / values[name]
        return (
            f": the loops reach Q/(mu P) = {ratio:.2g}; add a test with a larger force, best into gross sliding "
            "(mfv.identify.plan predicts what it determines)"
        )


def _proposal(key: str, parts: dict[str, Any]) -> str:
    """The end of a message about an unknown parameter: the keys of groups with that name or the nearest one, as a question."""
    known = [
        (f"{group}%{name}", name)
        for group, part in parts.items()
        if not group.startswith("step")
        for name, kind in part._group().__annotations__.items()
        if kind in _REAL
    ] + [(RIG_STIFFNESS, RIG_STIFFNESS)]
    near = [full for full, name in known if name == key] or difflib.get_close_matches(key, [full for full, _ in known], n=1)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def _advance_with_rig(contact: Case, target: float, rig: float) -> None:
    """Prescribe the sum of the shift and of the deformation of the rig."""
    if math.isinf(rig):
        contact.advance(shift=target)
        return
    before = contact.save()
    first = len(contact["history/step"]) - 1
    loads = contact.loads
    reached = loads.shift + loads.tangential_force / rig
    # The rig takes a part of the motion, so this goes beyond the target; between events the response is linear.
    if contact.advance(shift=loads.shift + target - reached) != "complete":
        return
    shift, force = contact["history/shift"][first:], contact["history/tangential_force"][first:]
    total = shift + force / rig
    order = 1.0 if target > reached else -1.0
    wanted = float(np.interp(order * target, order * total, shift))
    contact.restore(before)
    contact.advance(shift=wanted)


def _extended(x: Array, points: Array, values: Array) -> Array:
    """Linear interpolation between points in either order, continued beyond the ends."""
    if points[0] > points[-1]:
        points, values = points[::-1], values[::-1]
    distinct = np.concatenate([[True], np.diff(points) > 1e-14 * np.ptp(points)])
    points, values = points[distinct], values[distinct]
    segment = np.clip(np.searchsorted(points, x) - 1, 0, points.size - 2)
    slope = np.diff(values) / np.diff(points)
    return np.asarray(values[segment] + slope[segment] * (x - points[segment]))


def _signed_distance(rows: Array, points: Array) -> Array:
    """Distance of rows (2, n) from a line through points (2, m) in a plane, its ends continued.

    Positive where the second coordinate of the rows is larger, for an increasing line.
    """
    step = np.diff(points, axis=1)
    length = np.hypot(step[0], step[1])
    kept = length > 1e-12 * length.max()
    origin, step, length = points[:, :-1][:, kept], step[:, kept], length[kept]
    along = step / length
    offset = rows[:, :, None] - origin[:, None, :]
    position = np.einsum("irk,ik->rk", offset, along)
    low = np.where(np.arange(length.size) == 0, -np.inf, 0.0)
    high = np.where(np.arange(length.size) == length.size - 1, np.inf, length)
    foot = np.clip(position, low, high)
    gap = offset - foot * along[:, None, :]
    nearest = np.argmin(np.einsum("irk,irk->rk", gap, gap), axis=1)
    row = np.arange(rows.shape[1])
    chosen = gap[:, row, nearest]
    direction = along[:, nearest] * np.where(along[0, nearest] + along[1, nearest] < 0.0, -1.0, 1.0)
    side = direction[0] * chosen[1] - direction[1] * chosen[0]
    return np.asarray(np.sign(side) * np.hypot(chosen[0], chosen[1]))


def _with_play(points: Array, play: float, force_range: float) -> Array:
    """A branch with a play in series: the shift jumps by it where the force changes its sign."""
    force, shift = points
    sides = np.sign(force)
    crossing = np.flatnonzero(sides[1:] * sides[:-1] < 0.0)
    if crossing.size == 0:
        return np.stack([force, shift + 0.5 * play * sides])
    at = int(crossing[0])
    share = force[at] / (force[at] - force[at + 1])
    zero = shift[at] + share * (shift[at + 1] - shift[at])
    edge = 1e-9 * force_range * sides[at]
    force = np.insert(force, at + 1, [edge, -edge])
    return np.stack([force, np.insert(shift, at + 1, [zero, zero]) + 0.5 * play * np.sign(force)])


def _inverse_information(jacobian: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The inverse of the information matrix, and which unknowns it does not determine; their variances are infinite."""
    norms = np.linalg.norm(jacobian, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    _, singular, directions = np.linalg.svd(jacobian / scale, full_matrices=False)
    is_null = singular <= 1e-7 * singular[0]
    lost = (norms == 0.0) | np.any(np.abs(directions[is_null]) > 1e-3, axis=0)
    inverse = 1.0 / np.where(is_null, np.inf, singular)
    covariance = (directions.T * inverse**2) @ directions / np.outer(scale, scale)
    covariance[lost, lost] = np.inf
    return covariance, lost


def _start(name: str, axis: Axis) -> float:
    """The start value of a parameter. Raises InputError."""
    values = list(axis.values)
    if len(values) != 1 or isinstance(values[0], bool) or not isinstance(values[0], (int, float)) or not 0.0 < values[0] < math.inf:
        raise input_error(f"'{name}': needs one positive start value, not {values if len(values) != 1 else values[0]!r}")
    return float(values[0])
