"""Manual pages from the --help and --keys of the programs, and the overview of mfv.

    build/venv/bin/python scripts/manual.py build/release/bin docs/man

Written are mfv.1, mfv_run.1, mfv_stress.1 and mfv_conventional.1 from --help, mfv_case.5 from mfv_run --keys and the beginning of
docs/namelist.md. A help text consists of its usage, paragraphs, and headings that end in a colon. Below a heading, lines of a
term, two blanks or more and an explanation are a list, and others are words; examples, and indented lines above the first
heading, are unchanged.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

PROGRAMS = {
    "mfv_run": "solve one case of frictional contact of elastic bodies",
    "mfv_stress": "stresses inside the bodies of a contact that has been solved",
    "mfv_conventional": "solve one case of contact by load steps, for comparison",
}
ABOUT_MFV = "write, solve and draw cases of frictional contact, and studies of many"
# The command without arguments, from the source tree.
OVERVIEW = f"import sys; sys.path.insert(0, {str(ROOT / 'python')!r}); sys.argv = ['mfv']; from mfv.commands import main; main()"
# Page, program whose keys it has, document whose beginning it takes, what it is about.
TEXTS = {
    "mfv_case": ("mfv_run", "docs/namelist.md", "text of a case of frictional contact, with every key"),
}
# Day of the pages: the one on which programs or keys changed last.
DAY = "2026-11-28"
# A term and its explanation in a list of a help text.
TERM = r"  (\S.*?) {2,}(\S.*)"


def main() -> int:
    parser = argparse.ArgumentParser(description="Make the manual pages from --help and --keys of the programs.")
    parser.add_argument("programs", type=Path, help="folder of the programs, such as build/release/bin")
    parser.add_argument("folder", type=Path, help="output folder, such as docs/man")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for name, text in pages(arguments.programs).items():
        (arguments.folder / name).write_text(text)
    return 0


def pages(programs: Path) -> dict[str, str]:
    """The pages by file name. programs: folder of the programs."""
    made = {"mfv.1": program_page("mfv", ABOUT_MFV, output_of(sys.executable, "-c", OVERVIEW))}
    for program, about in PROGRAMS.items():
        made[f"{program}.1"] = program_page(program, about, output_of(programs / program, "--help"))
    for page, (program, document, about) in TEXTS.items():
        beginning = (ROOT / document).read_text().split("\n## ")[0]
        made[f"{page}.5"] = text_page(page, about, beginning, output_of(programs / program, "--keys"))
    return made


def output_of(*command) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def program_page(program: str, about: str, help_text: str) -> str:
    """A page of section 1 from a help text."""
    usage, _, rest = help_text.partition("\n\n")
    synopsis = [line.removeprefix("usage:").strip() for line in usage.split("\n")]
    lines = [*header(program, 1, about), ".SH SYNOPSIS", ".nf"]
    lines += [re.sub(rf"\b{program}\b", rf"\\fB{program}\\fP", escaped(line)) for line in synopsis]
    lines += [".fi", ".SH DESCRIPTION"]
    section = ""
    for block in rest.rstrip("\n").split("\n\n"):
        heading = re.match(r"([A-Z][\w ]*):\n(?=  )", block)
        if heading:
            section = heading[1]
            lines.append(f".SH {section.upper()}")
        rows = block[heading.end() if heading else 0 :].split("\n")
        if not rows[0].startswith("  "):
            lines += [*paragraph(lines), *filled(" ".join(rows))]
        elif section == "Examples" or not section:
            lines += example(lines, rows)
        elif re.match(TERM, rows[0]):
            lines += definitions(rows)
        else:
            lines += filled(" ".join(row.strip() for row in rows))
    return "\n".join(lines) + "\n"


def definitions(rows: list[str]) -> list[str]:
    """A list of terms, each with its explanation; explanations go on in lines that are indented further."""
    items = []
    for row in rows:
        item = re.match(TERM, row)
        if item:
            items.append([item[1], item[2]])
        else:
            items[-1][1] += " " + row.strip()
    return [line for term, words in items for line in (".TP", f"\\fB{escaped(term)}\\fP", *filled(words))]


def example(before: list[str], rows: list[str]) -> list[str]:
    """Lines as they stand, with a blank one between them and words before."""
    blank = [] if before[-1].startswith(".SH") else [".sp"]
    return [*blank, ".RS 2", ".nf", *(escaped(row.removeprefix("  ")) for row in rows), ".fi", ".RE"]


def paragraph(before: list[str]) -> list[str]:
    """What begins a paragraph after the lines before it: nothing right after a heading."""
    return [] if before[-1].startswith(".SH") else [".PP"]


def text_page(page: str, about: str, beginning: str, keys: str) -> str:
    """A page of section 5 from the beginning of a document and the tables of keys."""
    lines = [*header(page, 5, about), ".SH DESCRIPTION"]
    for block in beginning.strip().split("\n\n")[1:]:
        fenced = re.fullmatch(r"```\w*\n(.*)\n```", block, re.DOTALL)
        lines += example(lines, fenced[1].split("\n")) if fenced else [*paragraph(lines), *filled(" ".join(block.split("\n")))]
    lines += [".SH KEYS"]
    for group in re.split(r"^### ", keys, flags=re.MULTILINE)[1:]:
        title, *rows = group.strip().split("\n")
        lines.append(f".SS {escaped(title)}")
        for row in rows[3:]:
            name, value, default, unit, meaning = (cell.strip() for cell in row.strip("| ").split(" | "))
            stated = value + (f"; unit {unit}" if unit else "") + (f"; default {default.strip('`')}" if default != "-" else "")
            lines += [".TP", f"\\fB{escaped(name.strip('`'))}\\fP", *filled(stated)]
            lines += [".br", *filled(meaning.removesuffix(".") + ".")]
    programs = ", ".join(f"{program}(1)" for program in ("mfv", *PROGRAMS))
    return "\n".join([*lines, ".SH SEE ALSO", *filled(programs)]) + "\n"


def header(page: str, section: int, about: str) -> list[str]:
    version = (ROOT / "VERSION").read_text().strip()
    return [
        r".\" Made by scripts/manual.py from --help and --keys of the programs. Do not edit.",
        f'.TH {page.upper()} {section} "{DAY}" "MFV {version}" "MFV"',
        ".SH NAME",
        f"{escaped(page)} \\- {escaped(about)}",
    ]


def filled(text: str) -> list[str]:
    """Words in lines of moderate length, with what is Markdown in them: links to their words, code to bold."""
    text = re.sub(r"\[([^]]+)\]\([^)]*\)", r"\1", text)
    bold = [re.sub(r"`([^`]+)`", r"\\fB\1\\fP", escaped(line)) for line in lines_of_words(text)]
    return [line for line in bold if line]


def lines_of_words(text: str) -> list[str]:
    """Lines that do not cut what is between backquotes."""
    words = re.findall(r"(?:`[^`]*`|[^\s`])+", text)
    lines = [""]
    for word in words:
        if len(lines[-1]) + len(word) > 64:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def escaped(text: str) -> str:
    """A line of text as roff takes it."""
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq").replace("^", r"\(ha").replace("~", r"\(ti")
    return r"\&" + text if text.startswith(".") else text


if __name__ == "__main__":
    sys.exit(main())
