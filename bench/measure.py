"""Measure MFV and write docs/performance.md with its pictures. Everything takes about a quarter of an hour.

cmake --preset release && cmake --build --preset release --target bench
PYTHONPATH=python build/venv/bin/python bench/measure.py                 # everything but --long
PYTHONPATH=python build/venv/bin/python bench/measure.py --only peer     # the other sections from results.json
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("MFV_LIBRARY", str(ROOT / "build/release/lib/libmfv.so"))

import accuracy
import circle
import events
import peer
import rough
import targets
from harness import CERTIFICATE, CERTIFICATE_DIRECT, Bench

MODULES = {"targets": targets, "peer": peer, "events": events, "accuracy": accuracy, "circle": circle, "rough": rough}
HEAD = """# Performance

How long a case takes, which knob to turn first, and how MFV compares with other programs; from [targets](#targets) on for developers. Written by `bench/measure.py`; do not edit. Times are of one machine
({machine}) with one thread, the least of several runs: compare them with each other, not with yours. Measured:
{dates}.

Every run has to be complete, with a certificate below {direct:.0e} ({iterative:.0e} with fft, 0.01 of the accuracy of large increments): {gate}
"""


def main() -> None:
    """Measure, save the numbers, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=[*MODULES, "none"], help="sections to measure; none: write the page")
    parser.add_argument("--quick", action="store_true", help="smaller meshes, fewer repeats, for a trial")
    parser.add_argument("--long", action="store_true", help="also measure 10,000 nodes (about 10 minutes)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bin/bench")
    parser.add_argument("--results", type=Path, default=Path(__file__).with_name("results.json"), help="file of the numbers")
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help="where performance.md goes")
    parser.add_argument("--limit", type=float, default=1800.0, help="time limit of a process in seconds")
    options = parser.parse_args()
    results: dict[str, Any] = json.loads(options.results.read_text()) if options.results.exists() else {}
    failed = False
    for name in options.only or MODULES:
        if name == "none":
            continue
        bench = Bench(options.program, options.limit)
        print(f"{name} ...", flush=True)
        results[name] = MODULES[name].measure(bench, options.quick) | gate(bench)
        failed = failed or bool(bench.broken)
        options.results.write_text(json.dumps(results, indent=1) + "\n")
    if options.long:
        bench = Bench(options.program, options.limit)
        results["long"] = targets.measure_long(bench) | gate(bench)
        options.results.write_text(json.dumps(results, indent=1) + "\n")
    (options.docs / "performance.md").write_text(page(results, options.docs / "pictures"))
    sys.exit(1 if failed else 0)


def gate(bench: Bench) -> dict[str, Any]:
    """Number of checked runs, their largest certificate and violations."""
    return {"runs": bench.runs, "broken": bench.broken, "largest_certificate": bench.largest_certificate}


def page(results: dict[str, Any], pictures: Path) -> str:
    """All sections with numbers."""
    pictures.mkdir(parents=True, exist_ok=True)
    parts = [head(results)]
    for name in ("accuracy", "peer", "rough", "targets", "events", "circle"):
        if name == "targets" and name in results:
            parts.append(targets.section(results[name], results.get("long")))
        elif name in results:
            parts.append(MODULES[name].section(results[name], pictures))
    return "\n".join(part.strip("\n") + "\n" for part in parts)


def head(results: dict[str, Any]) -> str:
    """The head of the page, with the checks of the runs."""
    runs = sum(entry["runs"] for entry in results.values())
    broken = [text for entry in results.values() for text in entry["broken"]]
    largest = max(entry["largest_certificate"] for entry in results.values())
    verdict = f"all {runs} are, the largest is {largest:.0e}." if not broken else f"{len(broken)} of {runs} are NOT:\n\n"
    verdict += "\n".join(f"    {line}" for text in broken for line in text.splitlines())
    loads = ", ".join(f"{name} {entry['date']}" for name, entry in results.items())
    return HEAD.format(machine=machine(), dates=loads, direct=CERTIFICATE_DIRECT, iterative=CERTIFICATE, gate=verdict)


def machine() -> str:
    """The processor's name."""
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown"


if __name__ == "__main__":
    main()
