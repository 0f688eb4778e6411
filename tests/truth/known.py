"""The findings of the suite that are known: what is not reached yet, by reason, in known_findings.txt."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

FOLDER = Path(__file__).parent
FILE = FOLDER / "known_findings.txt"
#: The reason of findings that are new; the suite does not accept it.
UNCLASSIFIED = "not classified"

#: Seed and name of a finding.
Finding = tuple[int, str]


def suite_seeds() -> list[int]:
    """The seeds of the suite."""
    return [int(seed) for seed in (FOLDER / "suite_seeds.txt").read_text().split()]


def known_findings() -> dict[Finding, str]:
    """Reason by finding. In the file a line '## reason' is followed by lines of a seed and a name."""
    found, reason = {}, ""
    for line in FILE.read_text().splitlines():
        if line.startswith("## "):
            reason = line[3:].strip()
        elif line and not line.startswith("#"):
            seed, _, name = line.strip().partition(" ")
            found[int(seed), name] = reason
    return found


def write_known(findings: list[Finding]) -> None:
    """Write the file: findings that it has keep their reasons, others are not classified."""
    known, by_reason = known_findings(), defaultdict(list)
    for finding in sorted(findings):
        by_reason[known.get(finding, UNCLASSIFIED)].append(finding)
    lines = ["# What the suite finds and is not mended yet, by reason: seed and name (python -m truth --update-known writes it)."]
    for reason, those in sorted(by_reason.items()):
        lines += ["", f"## {reason}", *(f"{seed} {name}" for seed, name in those)]
    FILE.write_text("\n".join(lines) + "\n")
