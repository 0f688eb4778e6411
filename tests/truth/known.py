"""The findings that are known: what is not reached yet, with the reason, in known_findings.txt."""

from __future__ import annotations

from pathlib import Path

FILE = Path(__file__).parent / "known_findings.txt"


def known_findings() -> dict[tuple[int, str], str]:
    """Reason by seed and name. A line has the seed, the name and, after a '#', the reason."""
    found = {}
    for line in FILE.read_text().splitlines():
        if line and not line.startswith("#"):
            what, _, reason = line.partition("#")
            seed, _, name = what.strip().partition(" ")
            found[int(seed), name.strip()] = reason.strip()
    return found
