"""Chapter 6 of the dissertation, computed again: Figures 6.1 to 6.5, what the text says about them, and what it does not.

    python examples/decoupling/study.py [--output FOLDER] [--quick] [--publish]

Runs the studies beside this file (cases that FOLDER has already are not solved again) and writes report.html, numbers.csv and a
CSV for every figure into FOLDER. Needs the package mfv with its extra `study`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import report
import sweeps
from beyond import draw_beyond
from chapter_six import draw_chapter
from drawing import Drawn
from statements import Statement, all_statements

import mfv

HERE = Path(__file__).resolve().parent
STYLE: dict[Any, Any] = {
    "font.size": 10,
    "axes.linewidth": 0.6,
    "legend.frameon": False,
    "axes.formatter.use_mathtext": True,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
}


def arguments() -> argparse.Namespace:
    """The command-line options."""
    parser = argparse.ArgumentParser(description="chapter 6 of the dissertation, computed again")
    parser.add_argument("--output", type=Path, default=Path("decoupling"), help="folder of tables and report (decoupling)")
    parser.add_argument("--quick", action="store_true", help="few values on every axis, coarse meshes: half a minute")
    parser.add_argument("--publish", action="store_true", help="renew the pictures and statements in examples/ and docs/ too")
    return parser.parse_args()


def write(folder: Path, drawings: Sequence[Drawn], statements: Sequence[Statement], page: str) -> None:
    """Everything that is for reading."""
    (folder / "report.html").write_text(page, encoding="utf-8")
    report.write_statements(folder / "numbers.csv", statements)
    for drawn in drawings:
        report.write_columns(folder / f"{drawn.name}.csv", drawn.numbers)


def publish(drawings: Sequence[Drawn], statements: Sequence[Statement]) -> None:
    """The pictures and statements that the repository keeps."""
    pictures, docs = HERE / "pictures", HERE.parents[1] / "docs" / "pictures"
    pictures.mkdir(exist_ok=True)
    for drawn in drawings:
        path = docs / f"decoupling_{drawn.name}.png" if drawn.in_docs else pictures / f"{drawn.name}.png"
        path.write_bytes(report.picture_bytes(drawn))
    head = f"# Statement by statement\n\nWritten by `study.py --publish`; do not edit. {report.counted(statements)}\n\n"
    (HERE / "statements.md").write_text(head + report.markdown(statements), encoding="utf-8")


def main() -> None:
    options = arguments()
    folder = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    tables = {}
    for name in sweeps.NAMES:
        tables[name] = sweeps.run(name, folder, options.quick)
        print(f"{name}: {len(tables[name])} cases", flush=True)
    results = {str(row["coupling"]): mfv.read(folder / row["result_file"]) for row in tables["cyclic"].rows}
    with matplotlib.rc_context(STYLE):
        drawings = [*draw_chapter(tables, results), *draw_beyond(tables)]
        statements = all_statements(tables, results, options.quick)
        write(folder, drawings, statements, report.page(drawings, statements, tables, options.quick))
        if options.publish:
            publish(drawings, statements)
    print(f"{folder / 'report.html'}: {len(drawings)} figures, {len(statements)} statements")


if __name__ == "__main__":
    main()
