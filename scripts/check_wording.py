"""Finds phrases that the project does not use, and overlong lines: python check_wording.py [FILE ...] (all tracked files by default).

The project writes plain, idiomatic English in the field's terms. Each rule is a phrase, as a regular expression, and what to write
instead. Exits with 1 if anything is found. A line that ends in "wording: ok" is skipped.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

#: Phrase, and what to write instead.
RULES = {
    r"means? nothing (with|without|for|where)": "has no effect with ...",
    r"(is|are) (there|given) too\b": "is also given",
    r"\bunless told\b": "by default",
    r"\bleft out\b": "omitted",
    r"\blets? (go|snap)\b": "relax, release",
    r"\bcompanions?\b": "coarser mesh",
    r"\bthe pole\b": "the origin of x",
    r"\bto the bit\b": "bit-identical",
    r"\bstraight parts?\b": "load segment",
    r"\bfor want of\b": "because of a lack of",
    r"\bmakes? way\b": "is overwritten",
    r"\bcannot decide\b": "no consistent status",
    r"\bcome(s)? again\b": "is repeated, is reused",
    r"\bbodies part\b|\bpart again\b": "separate",
    r"\b(is|are) no (text|number|file|result|array|list|path|directory|folder)\b": "is not a ...",
    r"\bled by displacements?\b|\blead (the|a) load": "displacement control; prescribe, apply",
    r"\ball the same\b": "nevertheless, equal",
    r"\bstands? on\b": "depends on, links to",
    r"\b(is|are) told\b": "is reported",
    r"\bso many\b": "this many, a number of",
    r"\bwas freed, or is none\b": "is null, freed or invalid",
    r"\b(Make|make) .{1,30} safe from\b": "protect",
}
#: Suffixes of the files that are read, with their longest line.
LONGEST = {".f90": 132, ".pf": 132, ".nml": 160, ".c": 160, ".h": 140, ".sh": 160, ".def": 160, ".py": 160, ".md": 240}


def findings(path: Path) -> list[str]:
    """Lines of a file that break a rule, as file:line: what to write."""
    found = []
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        if line.rstrip().endswith("wording: ok"):
            continue
        where = f"{path.relative_to(ROOT)}:{number}"
        for phrase, instead in RULES.items():
            match = re.search(phrase, line)
            if match:
                found.append(f"{where}: '{match[0]}': write '{instead}'")
        if len(line) > LONGEST[path.suffix] and path.parts[-2] != "bench" and "http" not in line and not line.startswith("|"):
            found.append(f"{where}: {len(line)} characters, at most {LONGEST[path.suffix]}")
    return found


def main() -> int:
    """Check the files of the command line or all tracked ones."""
    names = sys.argv[1:]
    if not names:
        names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    paths = [path for name in names if (path := (ROOT / name)).suffix in LONGEST and path.exists()]
    found = [line for path in paths if path.name != Path(__file__).name for line in findings(path)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
