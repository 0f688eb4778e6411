"""mfv loads: the loads of a contact in a finite-element result, as a table for &history."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._files import target
from .shared import add_output, number

if TYPE_CHECKING:
    from ..finite_elements import ContactLoads

NAME, HELP = "loads", "loads of a contact in a finite-element result"

DESCRIPTION = """\
Read nodal forces or tractions on the surface of a plane finite-element model over time, and write normal and tangential
force and bulk stresses as a table for &history file='...'. Also the edges of the contact, with K_N and K_T of the
tractions there, each with its error. Formats: CalculiX (.frd, .dat, with the input deck), Abaqus (field reports .rpt, CSV),
VTU, XDMF and Exodus (package meshio), CSV. Conventions and what each format needs: docs/from_fe.md.
"""

EXAMPLES = """\
examples:
  mfv loads pad.frd --surface PAD_BOTTOM --opposite SPECIMEN_TOP
                                      write pad_loads.txt, with both bulk stresses
  mfv loads nodes.csv --surface contact --thickness 10 -o loads.txt
                                      nodal forces of a model that is 10 thick
  mfv loads job.rpt --mesh job.inp --surface SLAVE --edges edges.csv
                                      positions from the input deck; edges, K_N and K_T, too
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("file", type=Path, metavar="RESULT", help="result of finite elements")
    parser.add_argument(
        "others", type=Path, metavar="MESH", nargs="*", help="meshes of later times, for formats with one time each"
    )
    parser.add_argument("--surface", metavar="NAME", help="node set, surface, or array at points that is not 0 on it")
    parser.add_argument("--opposite", metavar="NAME", help="surface of the other body, for its bulk stress")
    parser.add_argument(
        "--mesh", type=Path, metavar="DECK.inp", help="input deck with sets and positions (.frd, .dat: beside the result)"
    )
    parser.add_argument(
        "--column", metavar="KEY=NAME", action="append", default=[], help="name in the result, such as pressure=CPRESS"
    )
    add_output(parser, "FILE.txt", "table to write (default: RESULT_loads.txt)")
    parser.add_argument("--edges", type=Path, metavar="FILE.csv", help="write edges, K_N and K_T with their errors, too")
    parser.add_argument("--moment", action="store_true", help="write the moment, too, for bodies that could tilt")
    parser.add_argument(
        "--edge", choices=("left", "right"), help="write K_N and K_T of that edge in place of the forces, for shape='edge'"
    )
    parser.add_argument("--body", choices=("lower", "upper"), help="body of the surface (default: by the mesh, else by the forces)")
    parser.add_argument("--angle", type=number, default=0.0, metavar="DEGREES", help="of the x axis of the contact in the model")
    parser.add_argument("--centre", type=number, metavar="X", help="x = 0 of the scene (default: middle of the largest contact)")
    parser.add_argument("--thickness", type=number, metavar="LENGTH", help="of the model (default: that of a solid mesh, else 1)")
    parser.add_argument("--quadratic", action="store_true", help="without a mesh: every second node is between corners")
    parser.add_argument("--exerted", action="store_true", help="nodal forces are those that the body of the surface exerts")
    parser.add_argument("--reverse-shear", action="store_true", help="shear tractions are positive to the left on the lower body")
    parser.add_argument(
        "--length-scale", type=number, default=1.0, metavar="S", help="units of length of the case per unit of the model"
    )
    parser.add_argument(
        "--force-scale", type=number, default=1.0, metavar="S", help="units of force of the case per unit of the model"
    )


def run(options: argparse.Namespace) -> None:
    """Read, write, print the key. Raises OSError, InputError, ValueError, ModuleNotFoundError."""
    from ..finite_elements import from_fe

    first: Path = options.file
    files = [first, *options.others]
    usual = first.with_name(f"{first.stem}_loads.txt")
    path = target(options.output, usual, (".txt", ".csv", ".dat"), files)
    edges = None if options.edges is None else target(options.edges, first.with_name("edges.csv"), (".csv", ".txt"), [*files, path])
    loads = from_fe(
        files if options.others else first,
        options.surface,
        opposite=options.opposite,
        mesh=options.mesh,
        columns=_columns(options.column),
        body=options.body,
        angle=options.angle,
        centre=options.centre,
        thickness=options.thickness,
        quadratic=options.quadratic,
        sign=-1.0 if options.exerted else 1.0,
        shear_sign=-1.0 if options.reverse_shear else 1.0,
        length_scale=options.length_scale,
        force_scale=options.force_scale,
    )
    for note in loads.notes:
        print(f"mfv: {first}: {note}", file=sys.stderr)
    loads.write(path, moment=options.moment, edge=options.edge)
    if edges is not None:
        loads.write_edges(edges)
    _print(loads)
    names = list(loads.table(moment=options.moment, edge=options.edge))[1:]
    print(f"{path}: {len(loads.table()['time'])} turning points of {', '.join(names)}")
    print(f"&history file='{path}' /")


def _columns(given: list[str]) -> dict[str, str] | None:
    """Names in the result by quantity. Raises ValueError."""
    pairs = [text.partition("=") for text in given]
    wrong = next((text for text, (key, _, name) in zip(given, pairs) if not key or not name), None)
    if wrong is not None:
        raise ValueError(f"--column {wrong}: write KEY=NAME, such as pressure=CPRESS")
    return {key: name for key, _, name in pairs} or None


def _print(loads: ContactLoads) -> None:
    """Print the loads at the largest normal force, with errors where they are known."""
    at = int(np.argmax(loads.P))
    print(
        f"largest P at time {loads.t[at]:g}: P {loads.P[at]:.6g}, Q {loads.Q[at]:.6g}, M {loads.M[at]:.3g} about x = {loads.centre:.6g}"
    )
    for side, edge in (("left", loads.left), ("right", loads.right)):
        values = ((edge.x, edge.x_error), (edge.K_N, edge.K_N_error), (edge.K_T, edge.K_T_error))
        print(
            f"  {side + ' edge':12}"
            + ", ".join(f"{name} {_with_error(*pair, at)}" for name, pair in zip(("x", "K_N", "K_T"), values))
        )
    for body, bulk in (("lower", loads.lower_bulk), ("upper", loads.upper_bulk)):
        if bulk is not None:
            print(f"  {body} bulk  {_with_error(bulk.stress, bulk.error, at)}")


def _with_error(values: np.ndarray, errors: np.ndarray, at: int) -> str:
    """A value at a time and its error, or that one of them is unknown."""
    if not np.isfinite(values[at]):
        return "unknown"
    return f"{values[at]:.4g}" + (f" +- {errors[at]:.1g}" if np.isfinite(errors[at]) else "")
