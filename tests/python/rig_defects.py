"""Synthetic loops of a cylinder on a half-plane from the closed form, with the defects of rigs, and how `mfv.identify.fit` takes them.

    python tests/python/rig_defects.py [--seeds 100] [--only NAME]

prints the table of docs/verification.md (scripts/deep-rigs.sh) and fails if a defect is served in less than 90 %: mu = 0.45, noise 0.5 %
of the amplitudes of both columns, 200 rows a cycle, force to 0.7 mu P, a triangular and a sinusoidal cycle by turns. A defect is
served if the truth is inside the 95 % interval of mu and of that of the stiffness of the rig, or if a warning names it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mfv import Body, Friction, Mesh, Scene, identify, joint
from mfv.identify import Loop

P, MU, RIG = 100.0, 0.45, 1.0e5  # N/mm, 1, N/mm per mm
E, NU, RADIUS = 70000.0, 0.3, 10.0
TRUTH = {"friction%mu": MU, "rig_stiffness": RIG}
START = {"friction%mu": 0.6, "rig_stiffness": 7.0e4}
HALF_WIDTH = np.sqrt(8.0 * P * RADIUS * (1.0 - NU**2) / (np.pi * E))
#: Contact modulus, 1/m = sum (kappa + 1)/(4 G), of two equal half-planes.
MODULUS = E / (4.0 * (1.0 - NU**2))


def scene(nodes: int = 101) -> Scene:
    """Cattaneo and Mindlin's problem: equal materials, no coupling."""
    lower = Body.half_plane(youngs_modulus=E, poisson_ratio=NU)
    upper = Body.disk(RADIUS, youngs_modulus=E, poisson_ratio=NU)
    return Scene(lower, upper, friction=Friction.coulomb(1.0), mesh=Mesh(nodes=nodes, gap="parabolic"), coupling="none")


def first_loading(force: np.ndarray, pressing: float | np.ndarray = P) -> np.ndarray:
    """The shift of the first loading, with the rig in series."""
    return joint.mindlin_shift(force, pressing, HALF_WIDTH, RADIUS, MODULUS, MU) + force / RIG


@dataclass
class Rig:
    """A test and its defects. `ratio`: Q/(mu P); `noise`: of both columns over their half-ranges; `lag`: of the shift [degrees];
    `drift`: of the shift over a cycle, `offset`: of the force, `slack`: of the rig, over the half-ranges; `uneven`: rows at random
    times; `bits`: resolution of both columns; `spikes`: number of rows; `varying`: amplitude of P over its mean."""

    ratio: float = 0.7
    rows: int = 200
    cycles: int = 1
    sine: bool = False
    noise: float = 0.005
    lag: float = 0.0
    drift: float = 0.0
    offset: float = 0.0
    slack: float = 0.0
    uneven: bool = False
    bits: int = 0
    spikes: int = 0
    varying: float = 0.0
    wrong_sign: bool = False
    with_time: bool = False
    noise_is_given: bool = True

    def loop(self, seed: int) -> Loop:
        """One record that begins and ends at the largest force."""
        random = np.random.default_rng(seed)
        time = np.linspace(0.0, self.cycles, self.cycles * self.rows + 1)
        if self.uneven:
            time = np.sort(random.uniform(0.0, self.cycles, time.size))
        largest = self.ratio * MU * P
        force = largest * self._wave(time)
        pressing = P * (1.0 + self.varying * np.sin(2.0 * np.pi * time + 0.7))
        shift = self._shift(time - self.lag / 360.0, largest, pressing)
        half = float(np.max(np.abs(first_loading(np.array(largest)))))
        shift = shift + self.drift * half * time
        force = force + self.offset * largest
        noise = self.noise * largest, self.noise * half
        force = force + noise[0] * random.standard_normal(time.size)
        shift = shift + noise[1] * random.standard_normal(time.size)
        if self.bits:
            force, shift = (_digital(column, self.bits) for column in (force, shift))
        for row in random.choice(time.size, self.spikes, replace=False):
            column, size = (force, largest) if random.uniform() < 0.5 else (shift, half)
            column[row] += random.choice([-1.0, 1.0]) * random.uniform(0.1, 1.0) * size
        return Loop(
            force,
            -shift if self.wrong_sign else shift,
            pressing,  # type: ignore[arg-type]  # it takes the mean
            force_noise=noise[0] if self.noise_is_given else None,
            shift_noise=noise[1] if self.noise_is_given else None,
            **({"time": time} if self.with_time else {}),
        )

    def _wave(self, time: np.ndarray) -> np.ndarray:
        phase = np.cos(2.0 * np.pi * time)
        return phase if self.sine else 2.0 / np.pi * np.arcsin(np.clip(phase, -1.0, 1.0))

    def _shift(self, time: np.ndarray, largest: float, pressing: np.ndarray) -> np.ndarray:
        """By Masing's rules, exact for a constant normal force."""
        force, is_falling = largest * self._wave(time), np.mod(time, 1.0) < 0.5
        end = first_loading(np.array(largest), pressing)
        branch = first_loading(0.5 * (largest + np.where(is_falling, -1.0, 1.0) * force), pressing)
        slack = 0.5 * self.slack * float(np.max(end)) * np.sign(force)
        return np.where(is_falling, end - 2.0 * branch, 2.0 * branch - end) + slack


def _digital(column: np.ndarray, bits: int) -> np.ndarray:
    """A column as an analogue-to-digital converter gives it whose range is 1.3 times that of the column."""
    step = 1.3 * np.ptp(column) / 2**bits
    return np.asarray(step * np.round(column / step))


#: The ten defects, and none, by what a warning about them must say.
DEFECTS = {
    "none": (Rig(), ""),
    "lag 0.9 degrees": (Rig(lag=0.9), "lag"),
    "drift 0.5 % a cycle": (Rig(drift=0.005), "drift"),
    "force offset 3 %": (Rig(offset=0.03), "offset"),
    "slack 1 %": (Rig(slack=0.01), "slack"),
    "uneven sampling": (Rig(uneven=True), "uneven"),
    "8-bit columns": (Rig(bits=8), "resolution"),
    "spikes, 3 rows": (Rig(spikes=3), "spike"),
    "P varies by 4 %": (Rig(varying=0.04), "normal force varies"),
    "wrong sign": (Rig(wrong_sign=True), "sign"),
    "lag and drift": (Rig(lag=0.9, drift=0.005), "lag|drift"),
}


@dataclass
class Count:
    """Of fits: truth of mu inside, of the rig, a warning that names the defect, one of both, any warning; and mean and scatter of mu."""

    mu: int = 0
    rig: int = 0
    named: int = 0
    served: int = 0
    warned: int = 0
    values: tuple[float, ...] = ()
    widths: tuple[float, ...] = ()


def tried(rig: Rig, names: str, seeds: range, nodes: int = 61, shown: Callable[[identify.Fit], None] | None = None) -> Count:
    """Fit loops of a rig with sets of noise; triangular and sinusoidal cycles by turns."""
    count = Count()
    for seed in seeds:
        fitted = identify.fit(scene(nodes), replace(rig, sine=seed % 2 == 1).loop(seed), START)
        if shown:
            shown(fitted)
        inside = [low <= TRUTH[name] <= high for name in TRUTH for low, high in [fitted.interval(name)]]
        named = bool(names) and any(word in warning for warning in fitted.warnings for word in names.split("|"))
        low, high = fitted.interval("friction%mu")
        count.mu += inside[0]
        count.rig += inside[1]
        count.named += named
        count.served += all(inside) or named
        count.warned += bool(fitted.warnings)
        count.values += (fitted.values["friction%mu"],)
        count.widths += (0.5 * (high - low),)
    return count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=100, help="number of sets of noise")
    parser.add_argument("--only", help="part of the name of a defect")
    parser.add_argument("--show", action="store_true", help="print every fit")
    options = parser.parse_args()
    least = options.seeds
    print("| defect | mu inside | rig inside | named by a warning | inside or named | any warning | mean of mu | half-width |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for name, (rig, words) in DEFECTS.items():
        if options.only and options.only not in name:
            continue
        count = tried(rig, words, range(options.seeds), shown=print if options.show else None)
        print(
            f"| {name} | {count.mu} | {count.rig} | {count.named} | {count.served} | {count.warned} "
            f"| {np.mean(count.values):.3f} | {np.median(count.widths):.3f} |",
            flush=True,
        )
        least = min(least, count.served)
    print(f"inside or named: {least} of {options.seeds} or more")
    if least < 0.9 * options.seeds:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
