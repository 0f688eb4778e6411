"""Writes the tables of keys from the catalogue of the library, which `mfv_run --keys` prints.

    build/venv/bin/python scripts/keys.py [--check] build/release/bin

writes them into docs/namelist.md (all that follows "## All groups and keys") and python/mfv/templates/keys.md. With --check it changes
nothing, names files that are out of date, and exits with 1 if there are any.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/namelist.md"
TEMPLATE = ROOT / "python/mfv/templates/keys.md"
HEADING = "## All groups and keys\n\n"


def main() -> int:
    parser = argparse.ArgumentParser(description="Write the tables of keys from mfv_run --keys.")
    parser.add_argument("--check", action="store_true", help="only report files that are out of date")
    parser.add_argument("programs", type=Path, help="folder of mfv_run, such as build/release/bin")
    given = parser.parse_args()
    keys = subprocess.run([given.programs / "mfv_run", "--keys"], check=True, capture_output=True, text=True).stdout
    text, heading, _ = PAGE.read_text(encoding="utf-8").partition(HEADING)
    if not heading:
        raise SystemExit(f"{PAGE.relative_to(ROOT)} has no heading '{HEADING.strip()}'")
    outdated = {
        path: new for path, new in ((PAGE, text + heading + keys), (TEMPLATE, keys)) if path.read_text(encoding="utf-8") != new
    }
    for path, new in outdated.items():
        if given.check:
            print(
                f"{path.relative_to(ROOT)} is out of date: run build/venv/bin/python scripts/keys.py {given.programs}",
                file=sys.stderr,
            )
        else:
            path.write_text(new, encoding="utf-8")
    return 1 if given.check and outdated else 0


if __name__ == "__main__":
    sys.exit(main())
