"""Writes the tables of keys from the catalogue of the library, which `mfv_run --keys` prints.

    build/venv/bin/python scripts/keys.py [--check] build/release/bin

writes them into docs/namelist.md (all that follows "## All groups and keys"; keys that are as in an earlier group in one line) and
python/mfv/templates/keys.md, and the keys of the classes of python/mfv/scene.py, between "# keys of" and "# end of keys". With --check
it changes nothing, names files that are out of date, and exits with 1 if there are any.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/namelist.md"
TEMPLATE = ROOT / "python/mfv/templates/keys.md"
LINE_LENGTH = 132
SCENE = ROOT / "python/mfv/scene.py"
HEADING = "## All groups and keys\n\n"


#: Types of keys by the beginning of what they take; of those that take a list, by their group.
TYPES = {"a text": "str", ".true.": "bool", "a whole number": "int", "a number": "float"}
LISTS = {"friction": "Coefficient", "history": "LoadList"}

#: Keys of &layer that do not describe its material (besides `body`, which Python's Layer does not have).
NO_MATERIAL = ("thickness", "elasticity")


def with_keys(source: str, printed: str) -> str:
    """The source of the classes with the keys that the library prints, those that are always needed first."""
    groups: dict[str, list[tuple[str, str, bool]]] = {}
    for line in printed.splitlines():
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif row := re.match(r"\| `(\w+)` \| (.*?) \| .*? \| .*? \| (.*) \|$", line):
            key, takes, meaning = row.groups()
            if (group, key) != ("layer", "body"):
                groups.setdefault(group, []).append((key, type_of(group, key, takes), meaning.startswith("needed")))
    bodies = {
        f"&{group}": "".join(field(key, kind, "" if needed else " | None = None") for key, kind, needed in sorted_keys(keys))
        for group, keys in groups.items()
    }
    bodies["a material"] = "".join(field(key, kind, " | None") for key, kind, _ in groups["layer"] if key not in NO_MATERIAL)
    return re.sub(r"( +# keys of (.*)\n)[^#]*?( +# end of keys\n)", lambda found: found[1] + bodies[found[2]] + found[3], source)


def field(key: str, kind: str, end: str) -> str:
    """The line of a key in its class, in lines of their own the choices of a long one, as the formatter writes it."""
    line = f"    {key}: {kind}{end}\n"
    if len(line.rstrip()) <= LINE_LENGTH:
        return line
    choices = kind[len("Literal[") : -1]
    return f"    {key}: Literal[\n        {choices}\n    ]{end}\n"


def without_repeats(printed: str) -> str:
    """The tables with a line `As in &body: ...` in place of the rows that are those of an earlier group, or that say so."""
    earlier: dict[str, str] = {}
    parts = []
    for table in re.split(r"(?=^### &)", printed, flags=re.MULTILINE):
        group, kept, repeated = "", [], {}
        for line in table.rstrip("\n").split("\n"):
            if line.startswith("### &"):
                group = line.split()[1]
            key = re.match(r"\| (`\w+`) \|", line)
            said = re.search(r"\| as in (&\w+) \|$", line)
            first = said[1] if said else earlier.get(line, group)
            if key and first != group:
                repeated.setdefault(first, []).append(key[1])
            else:
                kept.append(line)
                earlier.setdefault(line, group)
        kept += [f"\nAs in {first}: {', '.join(keys)}." for first, keys in repeated.items()]
        parts.append("\n".join(kept))
    return "\n\n".join(parts).lstrip("\n") + "\n"


def sorted_keys(keys: list[tuple[str, str, bool]]) -> list[tuple[str, str, bool]]:
    """Keys that are always needed first: before Python 3.10 fields of a dataclass without a default precede the others."""
    return sorted(keys, key=lambda key: not key[2])


def type_of(group: str, key: str, takes: str) -> str:
    """The annotation of a key from what it takes."""
    if takes.startswith("'"):
        return "Literal[" + re.sub(r"'(\w+)'", r'"\1"', takes.replace(" or ", ", ")) + "]"
    if takes.endswith("or a list"):
        return LISTS.get(group, "Numbers")
    kind = next(kind for words, kind in TYPES.items() if takes.startswith(words))
    return "str | os.PathLike[str]" if kind == "str" and key.endswith("file") else kind


def main() -> int:
    parser = argparse.ArgumentParser(description="Write the tables of keys from mfv_run --keys.")
    parser.add_argument("--check", action="store_true", help="only report files that are out of date")
    parser.add_argument("programs", type=Path, help="folder of mfv_run, such as build/release/bin")
    given = parser.parse_args()
    keys = subprocess.run([given.programs / "mfv_run", "--keys"], check=True, capture_output=True, text=True).stdout
    text, heading, _ = PAGE.read_text(encoding="utf-8").partition(HEADING)
    if not heading:
        raise SystemExit(f"{PAGE.relative_to(ROOT)} has no heading '{HEADING.strip()}'")
    made = {PAGE: text + heading + without_repeats(keys), TEMPLATE: keys, SCENE: with_keys(SCENE.read_text(encoding="utf-8"), keys)}
    outdated = {path: new for path, new in made.items() if path.read_text(encoding="utf-8") != new}
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
