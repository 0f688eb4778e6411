"""Comments of the templates of `python -m mfv new`: the meaning of every key, from the catalogues of the programs.

    python scripts/templates.py build/release/bin

writes them anew into python/mfv/templates. In a template a key stands on a line of its own, `key = value`, or `! key = value`
where it is left out. What stands in comments above it is its meaning, put there by this program where the key comes for the
first time; a comment behind it on the line, and those between groups, are left as they are.
"""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from pathlib import Path

TEMPLATES = Path(__file__).resolve().parents[1] / "python" / "mfv" / "templates"

#: Programs whose catalogues have the keys.
PROGRAMS = ("mfv_run", "mfv_sweep")

#: Width of a comment with its indentation.
WIDTH = 100

#: Comment of a key, by group and key.
Meanings = dict[tuple[str, str], str]

GROUP = re.compile(r"^&(\w+)")
KEY = re.compile(r"^ +(?:! )?(\w+) = ")


def meanings_of(printed: str) -> Meanings:
    """Comments of the keys in what a program prints with --keys."""
    found: Meanings = {}
    group = ""
    for line in printed.splitlines():
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif line.startswith("| `"):
            key, value, default, unit, meaning = (cell.strip().strip("`") for cell in line.strip("|").split(" | "))
            notes = [value, *([f"in {unit}"] if unit else []), *([f"{default} by default"] if default != "-" else [])]
            found[group, key] = f"{meaning.rstrip(' |')} ({', '.join(notes)})"
    return found


def commented(template: str, comments: Meanings) -> str:
    """A template with a comment above every key that comes for the first time. Raises KeyError for one in no catalogue."""
    group, lines, told = "", [], set()
    for line in template.splitlines():
        starts = GROUP.match(line)
        group = starts.group(1) if starts else "" if line == "/" else group
        key = KEY.match(line)
        if group and line.lstrip().startswith("!") and (not key or (group, key.group(1)) not in comments):
            continue  # an earlier comment
        if group and key:
            name = group, key.group(1)
            if name not in told:
                indent = {"initial_indent": "   ! ", "subsequent_indent": "   ! ", "break_on_hyphens": False}
                lines += textwrap.wrap(comments[name], WIDTH, **indent)
            told.add(name)
        lines.append(line)
    return "\n".join(lines) + "\n"


def main(programs: Path) -> None:
    """Write the comments of all templates anew."""
    comments: Meanings = {}
    for program in PROGRAMS:
        printed = subprocess.run([programs / program, "--keys"], capture_output=True, text=True, check=True).stdout
        comments.update(meanings_of(printed))
    for path in sorted(TEMPLATES.glob("*.nml")):
        path.write_text(commented(path.read_text(encoding="utf-8"), comments), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
