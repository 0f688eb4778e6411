"""The picture at the top of the README, from the result of examples/fretting_pad.nml: python first_picture.py RESULT.h5 PICTURE.png"""

import sys

import matplotlib
from matplotlib.figure import Figure

import mfv
from mfv import drawing, plot


def main() -> None:
    """Tractions, stress along the surface, non-linear part of the loop."""
    result = mfv.read(sys.argv[1])
    with matplotlib.rc_context({**drawing.STYLE, "font.size": 12}):
        picture = Figure(figsize=(11.0, 3.9), layout="constrained")
        tractions, stress, loop = picture.subplots(1, 3)
        plot.shear(result, tractions)
        inside = result.state.pressure > 0.0
        tractions.plot(result.mesh.x[inside], result.state.pressure[inside], color="0.2", linewidth=1.2)
        tractions.text(0.0, 238.0, "pressure", color="0.2", fontsize=11, ha="center")
        tractions.text(0.0, 155.0, "friction limit", color="0.35", fontsize=10, ha="center")
        tractions.text(0.0, 68.0, "shear traction", color=drawing.NUMBERS, fontsize=11, ha="center")
        tractions.set(ylabel="tractions [N/mm$^2$]", title="What the pad does to the surface", ylim=(-12.0, 310.0))
        for place, zone in ((-1.14, "slip"), (0.0, "stick"), (1.14, "slip")):
            tractions.text(place, 285.0, zone, fontsize=11, ha="center", bbox={"color": "white", "alpha": 0.7, "pad": 1.5})
        plot.surface_stress(result, stress, len(result.steps))
        stress.set(title="What the trailing edge sees", ylabel=r"stress along the surface $\sigma_{xx}$ [N/mm$^2$]")
        history, work = result.history, result.observables.cycle_dissipation
        loop.plot(1000.0 * history.nonlinear_shift, history.tangential_force, color=drawing.NUMBERS, linewidth=1.0)
        loop.set(title="What a cycle dissipates", ylabel="tangential force [N/mm]")
        loop.set_xlabel("shift without its linear part [\N{GREEK SMALL LETTER MU}m]")
        loop.text(-0.1, -55.0, f"{work:.3g} N mm/mm\na cycle", ha="center", fontsize=11)
        picture.savefig(sys.argv[2], dpi=130)


if __name__ == "__main__":
    main()
