"""Mesh study: errors against the closed forms over the number of intervals, with the orders of convergence.

    python examples/mesh_study.py [-o PICTURE.png] [--finest N]

Errors are means over eight loads or coefficients of friction, so that the place of an edge in its interval averages out.
Tractions: relative l2 error at the nodes (flat punch: inside 0.9 a, away from its singular edges). The closed forms are those
of the library, taken from the results.
"""

from __future__ import annotations

import argparse

import numpy as np

import mfv

CASE = """
&scene coupling='goodman' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body {body}, rigid=.true. /
&mesh nodes={nodes}, {mesh} /
&friction law='coulomb', mu={mu} /
&step normal_force={force}, friction={friction} /
{more}
"""
CYLINDER = {"body": "shape='disk', radius=0.25", "mesh": "half_width=0.0127, gap='parabolic'"}
PUNCH = {"body": "shape='flat_punch', half_width=0.4", "mesh": "half_width=0.4"}
SHEAR = "&step tangential_force={q} /\n&step tangential_force=-{q}, cycles=1 /"
VARIANTS = np.linspace(0.0, 1.0, 8)


def solved(case: dict, nodes: int, force=1.0e-3, mu=0.7, friction=False, more="") -> mfv.Result:
    """The result of one case."""
    return mfv.run(text=CASE.format(**case, nodes=nodes, force=force, mu=mu, friction=f".{friction}.".lower(), more=more))


def error(numbers: np.ndarray, exact: np.ndarray, inside=slice(None)) -> float:
    """Relative l2 error."""
    return np.linalg.norm((numbers - exact)[inside]) / np.linalg.norm(exact[inside])


def hertz(nodes: int, variant: float) -> dict[str, float]:
    """Pressure and half-width of the pressed cylinder."""
    result = solved(CYLINDER, nodes, force=8.0e-4 * (1 + 0.3 * variant), mu=0.0)
    a = result.reference.contact_half_width
    return {
        "Hertz: pressure": error(result.state.pressure, result.reference.pressure),
        "Hertz: half-width": abs(result.summary.contact_half_width / a - 1),
    }


def flat_punch(nodes: int, variant: float) -> dict[str, float]:
    """Pressure and, with friction, shear under the flat punch."""
    result = solved(PUNCH, nodes, mu=0.2 + 0.3 * variant, friction=True)
    inside = np.abs(result.mesh.x) < 0.9 * 0.4
    return {
        "flat punch: pressure": error(result.state.pressure, result.reference.pressure, inside),
        "flat punch with friction: shear": error(result.state.shear, result.reference.shear, inside),
    }


def spence(nodes: int, variant: float) -> dict[str, float]:
    """Shear and stick ratio of the cylinder pressed with friction."""
    mu = 0.2 + 0.8 * variant
    result = solved(CYLINDER, nodes, mu=mu, friction=True)
    ratio = mfv.reference.spence_stick_ratio(mu, result.scene.dundurs_beta)
    return {
        "Spence: shear": error(result.state.shear, result.reference.shear),
        "Spence: stick ratio": abs(result.summary.stick_ratio - ratio),
    }


def mindlin(nodes: int, variant: float) -> dict[str, float]:
    """Shear, stick ratio, shift and dissipation of a cycle of the sheared cylinder."""
    q, p, mu = 7.0e-4 * (0.3 + 0.5 * variant), 1.0e-3, 0.7
    result = solved(CYLINDER, nodes, force=p, mu=mu, more=SHEAR.format(q=q))
    first, cycled = result.steps[1], result.steps[3]
    exact = mfv.reference.mindlin_dissipation(q, p, result.reference.contact_half_width, 0.25, mu)
    return {
        "Mindlin: shear": error(result.state.shear, result.reference.shear),
        "Mindlin: stick ratio": abs(first.stick_ratio - mfv.reference.mindlin_stick_ratio(q, p, mu)),
        "Mindlin: shift": abs(result.history["shift"][-1] / result.reference["shift"][-1] - 1),
        "Mindlin: dissipation of a cycle": abs((cycled.dissipation - first.dissipation) / exact - 1),
    }


def mean_errors(nodes: int) -> dict[str, float]:
    """Mean over the variants of every error."""
    runs = [case(nodes, variant) for variant in VARIANTS for case in (hertz, flat_punch, spence, mindlin)]
    names = dict.fromkeys(name for run in runs for name in run)
    return {name: float(np.mean([run[name] for run in runs if name in run])) for name in names}


def draw(meshes: list[int], table: dict[str, list[float]], path: str) -> None:
    """The errors over the number of intervals."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(7, 4.6), layout="constrained")
    ax = picture.add_subplot()
    for (name, errors), marker in zip(table.items(), "osv^D<>phX*d8P"):
        ax.loglog(meshes, errors, marker=marker, markersize=5, linewidth=1.2, label=name)
    reach = np.array([meshes[0], meshes[-1]])
    ax.loglog(reach, 0.5 * table["Hertz: pressure"][0] * reach[0] / reach, "k--", linewidth=1, label="first order")
    ax.loglog(reach, 2 * table["Mindlin: shift"][0] * (reach[0] / reach) ** 2, "k:", linewidth=1, label="second order")
    ax.set_xticks(meshes, [str(nodes) for nodes in meshes])
    ax.minorticks_off()
    ax.set(xlabel="intervals of the mesh", ylabel="relative error", title="Errors against closed forms")
    ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    picture.savefig(path, dpi=180)


def main() -> None:
    parser = argparse.ArgumentParser(description="errors against the closed forms over the number of intervals")
    parser.add_argument("-o", "--output", help="picture to draw")
    parser.add_argument("--finest", type=int, default=201, help="number of nodes of the finest mesh (default: 201)")
    options = parser.parse_args()
    meshes = [n for n in (25, 51, 101, 201, 401) if n <= options.finest]
    columns = [mean_errors(nodes) for nodes in meshes]
    table = {name: [column[name] for column in columns] for name in columns[0]}
    print("| quantity | " + " | ".join(f"{nodes}" for nodes in meshes) + " | order |")
    print("| --- |" + " --- |" * (len(meshes) + 1))
    for name, errors in table.items():
        order = -np.polyfit(np.log(meshes), np.log(errors), 1)[0]
        print(f"| {name} | " + " | ".join(f"{value:.1e}" for value in errors) + f" | {order:.2f} |")
    if options.output:
        draw(meshes, table, options.output)


if __name__ == "__main__":
    main()
