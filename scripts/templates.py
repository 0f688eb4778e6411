"""Comments of the templates of `python -m mfv new`: the meaning of every key, from the catalogues of mfv_run and of studies.

    build/venv/bin/python scripts/templates.py build/release/bin

writes them anew into python/mfv/templates. In a template a key stands on a line of its own, `key = value`, or `! key = value`
where it is left out. What stands in comments above it is its meaning, put there by this program where the key comes for the
first time; a comment behind it on the line, and those between groups, are left as they are.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

PYTHON = Path(__file__).resolve().parents[1] / "python"
TEMPLATES = PYTHON / "mfv" / "templates"

#: Width of a comment with its indentation.
WIDTH = 100

#: Comment of a key, by group and key.
Meanings = dict[tuple[str, str], str]

GROUP = re.compile(r"^&(\w+)")
KEY = re.compile(r"^ +(?:! )?(\w+) = ")


def catalogues(run: Path) -> str:
    """What mfv_run and `python -m mfv study` print with --keys: the keys of cases and of studies."""
    printed = ""
    for command in ([run], [sys.executable, "-m", "mfv", "study"]):
        environment = {**os.environ, "PYTHONPATH": str(PYTHON)}
        ended = subprocess.run([*command, "--keys"], env=environment, stdout=subprocess.PIPE, text=True, check=True)
        printed += ended.stdout
    return printed


def meanings_of(printed: str) -> Meanings:
    """Comments of the keys in what a program prints with --keys: tables with or without a column for units."""
    found: Meanings = {}
    group, columns = "", [""]
    for line in printed.splitlines():
        cells = [cell.strip().strip("`") for cell in line.removeprefix("|").removesuffix("|").split(" | ")]
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif line.startswith("| key |"):
            columns = cells
        elif line.startswith("| `"):
            row = dict(zip(columns, cells))
            unit, default = row.get("unit"), row["default"]
            notes = [row["value"], *([f"in {unit}"] if unit else []), *([f"{default} by default"] if default != "-" else [])]
            found[group, row["key"]] = f"{row['meaning']} ({', '.join(notes)})"
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
    comments = meanings_of(catalogues(programs / "mfv_run"))
    for path in sorted(TEMPLATES.glob("*.nml")):
        path.write_text(commented(path.read_text(encoding="utf-8"), comments), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
