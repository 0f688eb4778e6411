"""Cost of maps: cases, seconds and seconds of the processors of 2,500 points with their boundaries, on all processors.

Prints a Markdown table. Some minutes. build/venv/bin/python bench/map.py [--points N]
"""

from __future__ import annotations

import argparse
import os
import sqlite3
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("MFV_LIBRARY", str(ROOT / "build/release/lib/libmfv.so"))

import mfv
from mfv.studies import regime_map


def scenes() -> dict[str, mfv.Scene]:
    """The cases: Mindlin's problem, a pad with events of both bodies, and the same with a search for yielding."""
    pad, yielding = (mfv.Scene.from_file(ROOT / "examples/fretting_pad.nml") for _ in range(2))
    yielding.lower.yield_strength = 250
    return {
        "mindlin.nml": mfv.Scene.from_file(ROOT / "examples/mindlin.nml"),
        "fretting_pad.nml": pad,
        "fretting_pad.nml, yield_strength": yielding,
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=50, help="points along both axes")
    options = parser.parse_args()
    print("| case | points | cases solved | points of boundaries | s | s of processors |", "| --- |" + " --- |" * 5, sep="\n")
    for name, scene in scenes().items():
        with tempfile.TemporaryDirectory() as folder:
            store = Path(folder) / "map.sqlite"
            before, of_processors = time.perf_counter(), time.process_time()
            table = regime_map(scene, points=options.points, stick_ratio=0.9, store=store)
            seconds, of_processors = time.perf_counter() - before, time.process_time() - of_processors
            (solved,) = sqlite3.connect(store).execute("SELECT count(*) FROM cases").fetchone()
        print(
            f"| {name} | {options.points**2} | {solved} | {table.sizes['crossing']} | {seconds:.1f} | {of_processors:.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
