"""Static and kinetic friction depends on the mesh: stick ratio over the nodes in contact, and weakening friction beside it.

    python examples/static_kinetic_mesh.py [-o PICTURE.png] [--finest N] [--distances D ...]

Mindlin's problem: a rigid cylinder is pressed without friction and sheared by Q = 0.475 mu_s P, the ratio of the dissertation's
section 5.2, with mu_s = 0.7 and mu_k = 0.49. Under static and kinetic friction the stick ratio decreases with mesh refinement, from
sqrt(1 - Q/(mu_s P)) towards sqrt(1 - Q/(mu_k P)). With weakening friction, whose coefficient falls over a slip distance D, it
converges once the intervals resolve the slip over D.
"""

from __future__ import annotations

import argparse

import mfv

CASE = """
&scene coupling='goodman' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width={half_width}, gap='parabolic' /
&friction {friction}, mu_static=0.7, mu_kinetic=0.49 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force={force} /
&output history='none' /
"""
FORCE, MU_STATIC, MU_KINETIC = 1.0e-3, 0.7, 0.49
SHEAR = 0.475 * MU_STATIC * FORCE
MESHES = (43, 79, 157, 321, 641)
SPARE = 8  # intervals of the mesh beyond the contact


def stick_ratio(nodes: int, friction: str) -> float:
    """Stick ratio with this many intervals over Hertz's contact."""
    half_width = float(mfv.reference.hertz_half_width(FORCE, 0.25, 1.0, 1.8)) * (nodes + SPARE) / nodes
    result = mfv.run(text=CASE.format(nodes=nodes + SPARE, half_width=half_width, friction=friction, force=SHEAR), check=True)
    if result.summary.contact_nodes != nodes:
        raise RuntimeError(f"{result.summary.contact_nodes} nodes are in contact, not {nodes}")
    return float(result.summary.stick_ratio)


def laws(distances: list[float]) -> dict[str, str]:
    """The rows of the table: name, and friction in the case."""
    weakening = {f"weakening, D = {d:.0e}": f"law='weakening', weakening_distance={d}" for d in distances}
    return {"static and kinetic": "law='static_kinetic'"} | weakening


def limits() -> dict[str, float]:
    """Mindlin's stick ratios with either coefficient."""
    return {
        name: float(mfv.reference.mindlin_stick_ratio(SHEAR, FORCE, mu))
        for name, mu in ((r"$\sqrt{1-Q/(\mu_s P)}$", MU_STATIC), (r"$\sqrt{1-Q/(\mu_k P)}$", MU_KINETIC))
    }


def draw(meshes: list[int], table: dict[str, list[float]], path: str) -> None:
    """The stick ratios over the nodes in contact."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(7, 4.6), layout="constrained")
    ax = picture.add_subplot()
    for (name, ratios), marker in zip(table.items(), "osv^D<>"):
        ax.semilogx(meshes, ratios, marker=marker, markersize=5, linewidth=1.2, label=name)
    for (name, ratio), dashes in zip(limits().items(), ("--", ":")):
        ax.axhline(ratio, color="k", linestyle=dashes, linewidth=1, label=name)
    ax.set_xticks(meshes, [str(nodes) for nodes in meshes])
    ax.minorticks_off()
    ax.set(xlabel="nodes in contact", ylabel="stick ratio", title="Static and kinetic friction depends on the mesh")
    ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    picture.savefig(path, dpi=180)


def main() -> None:
    parser = argparse.ArgumentParser(description="stick ratio under static and kinetic friction over the mesh")
    parser.add_argument("-o", "--output", help="picture to draw")
    parser.add_argument("--finest", type=int, default=321, help="number of contact nodes of the finest mesh (default: 321)")
    parser.add_argument("--distances", type=float, nargs="*", default=[1.0e-5, 3.0e-5, 1.0e-4], help="weakening distances")
    options = parser.parse_args()
    meshes = [nodes for nodes in MESHES if nodes <= options.finest]
    table = {name: [stick_ratio(nodes, friction) for nodes in meshes] for name, friction in laws(options.distances).items()}
    print("| law | " + " | ".join(f"{nodes}" for nodes in meshes) + " |")
    print("| --- |" + " --- |" * len(meshes))
    for name, ratios in table.items():
        print(f"| {name} | " + " | ".join(f"{ratio:.3f}" for ratio in ratios) + " |")
    if options.output:
        draw(meshes, table, options.output)


if __name__ == "__main__":
    main()
