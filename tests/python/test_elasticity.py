"""How a surface deforms, apart from its shape: a disk as a half-plane is a cylinder of Hertz's theory."""

import numpy as np
import pytest

import mfv
from mfv import Body, Friction, Mesh, Scene, Step

STEEL = {"youngs_modulus": 210e3, "poisson_ratio": 0.3}
ALUMINIUM = {"youngs_modulus": 70e3, "poisson_ratio": 0.33}
STEPS = [Step(normal_force=300.0), Step(tangential_force=60.0, cycles=1)]


def scene(pad: Body, gap: str | None = None, **mesh: float) -> Scene:
    return Scene(
        Body.half_plane(datum=70.0, **ALUMINIUM), pad, steps=STEPS, friction=Friction.coulomb(0.6), mesh=Mesh(gap=gap, **mesh)
    )


@pytest.mark.parametrize("mesh", [{"nodes": 61}, {"nodes": 61, "half_width": 1.1}])
def test_a_disk_as_a_half_plane_is_a_parabola_on_one(mesh: dict[str, float]) -> None:
    """The solution is that of a body of the power 2, which has no other elasticity."""
    round_pad = scene(Body.disk(70.0, elasticity="half_plane", datum=70.0, **STEEL), "parabolic", **mesh).run(check=True)
    power = scene(Body.power(1 / 140.0, 2.0, datum=70.0, **STEEL), **mesh).run(check=True)
    for name in ("pressure", "shear", "slip", "normal_displacement"):
        np.testing.assert_allclose(getattr(round_pad.state, name), getattr(power.state, name), rtol=1e-11, atol=1e-13, err_msg=name)
    for name in ("upper_tension", "lower_tension", "approach", "dissipation", "stick_ratio"):
        assert getattr(round_pad.observables, name) == pytest.approx(getattr(power.observables, name), rel=1e-10), name


def test_it_tends_to_the_disk_as_the_contact_shrinks() -> None:
    """A disk's own curvature and forces at its centre matter in the order of a/R."""
    differences = []
    for force in (1200.0, 300.0, 75.0):
        results = [
            Scene(
                Body.half_plane(**STEEL),
                Body.disk(20.0, elasticity=kind, **STEEL),
                steps=[Step(normal_force=force, friction=False), Step(tangential_force=0.4 * force)],
                friction=Friction.coulomb(0.6),
                mesh=Mesh(nodes=81),
            ).run(check=True)
            for kind in ("own", "half_plane")
        ]
        peaks = [result.observables.peak_pressure for result in results]
        differences.append(abs(peaks[1] / peaks[0] - 1.0))
    assert differences[0] < 0.01
    assert differences[2] < 0.6 * differences[1] < 0.36 * differences[0]


@pytest.mark.parametrize("seed", range(8))
def test_upside_down_and_mirrored(seed: int) -> None:
    """Random pairs of disks of which one or both deform as half-planes: the order of the bodies and the side do not matter."""
    draw = np.random.default_rng(seed)
    bodies = [
        Body.disk(
            draw.uniform(10.0, 100.0),
            youngs_modulus=draw.uniform(50e3, 200e3),
            poisson_ratio=draw.uniform(0.1, 0.45),
            elasticity="half_plane" if seed % 2 or number else "own",
        )
        for number in range(2)
    ]

    def numbers(lower: Body, upper: Body, side: float) -> list[float]:
        steps = [Step(normal_force=200.0), Step(tangential_force=60.0 * side), Step(tangential_force=-45.0 * side)]
        found = Scene(lower, upper, steps=steps, friction=Friction.coulomb(0.5), mesh=Mesh(nodes=45)).run(check=True).observables
        tensions = [found.lower_tension, found.upper_tension][:: 1 if lower is bodies[0] else -1]
        return [found.approach, found.peak_pressure, found.peak_shear, found.dissipation, found.stick_ratio, *tensions]

    here = numbers(*bodies, 1.0)
    assert numbers(*bodies, -1.0) == pytest.approx(here, rel=1e-7)
    assert numbers(*bodies[::-1], 1.0) == pytest.approx(here, rel=1e-7)


@pytest.mark.parametrize(
    ("body", "what"),
    [
        (
            {"elasticity": "half_plane", "kernel": "fourier"},
            "kernel='fourier': has no effect for a disk with elasticity='half_plane'",
        ),
        ({"elasticity": "half_plane", "harmonics": 40}, "harmonics=40: has no effect for a disk with elasticity='half_plane'"),
    ],
)
def test_keys_of_a_disk_s_own_elasticity_are_refused(body: dict[str, object], what: str) -> None:
    with pytest.raises(mfv.errors.InputError, match=what):
        scene(Body.disk(70.0, **STEEL, **body)).run()


def test_radial_normals_need_bodies_that_deform_round() -> None:
    bodies = [Body.hole(10.1, **STEEL), Body.disk(10.0, elasticity="half_plane", **STEEL)]
    with pytest.raises(mfv.errors.InputError, match="must be 'vertical' unless both bodies have elasticity='own'"):
        Scene(*bodies, steps=STEPS[:1], mesh=Mesh(normals="radial")).run()
