"""The reference of the C interface, from include/mfv.h: a comment, declarations below it, a blank line."""

from __future__ import annotations

import re
from pathlib import Path

from docstrings import escaped

CALLBACK = re.compile(r"^typedef \w+ \(\*(\w+)\)", re.MULTILINE)
PROTOTYPE = re.compile(r"^(?!typedef|enum|#)(\w[^;{}]*\([^;{}]*\));", re.MULTILINE)
STRUCT = re.compile(r"^typedef struct (\w+)(?: \w+;|( \{))", re.MULTILINE)
STATUS = re.compile(r'^MFV_STATUS\((\w+), (\d+), (\d+), "(.*?)", "(.*?)"\)', re.MULTILINE)


def write_c_reference(include: Path, page: Path) -> None:
    """Write the page. include: folder of mfv.h and mfv_status.def."""
    header = (include / "mfv.h").read_text()
    beginning = re.match(r"/\*(.*?)\*/", header, re.DOTALL)[1]
    lines = ["# C reference", "", *_paragraphs(beginning), ""]
    body = re.split(r'extern "C" \{\n#endif\n', header)[1].split("\n#ifdef __cplusplus")[0]
    for block in re.split(r"\n\n+", body):
        comment = re.match(r"\s*/\*(.*?)\*/\s*", block, re.DOTALL)
        if comment:
            lines += _described(_words(comment[1]), block[comment.end() :].strip())
    lines += ["## Statuses", "", "| name | code | exit code | outcome | what it says |", "| --- | --- | --- | --- | --- |"]
    for match in STATUS.finditer((include / "mfv_status.def").read_text()):
        lines.append("| `{}` | {} | {} | {} | {} |".format(*match.groups()))
    page.write_text("\n".join(lines) + "\n")


def _described(comment: str, declarations: str) -> list[str]:
    """A comment with what it is about, as directives of Sphinx's C domain, or as it stands where that has none."""
    signatures = [" ".join(each.split()) for each in PROTOTYPE.findall(declarations)]
    if signatures:
        declared = ["```{eval-rst}", ".. c:function:: " + "\n                ".join(signatures), ""]
        return [*declared, f"   {escaped(comment)}", "```", ""]
    words = _literal(comment)
    code = ["```c", declarations, "```", ""]
    types = ["struct " + name if opens else "type " + name for name, opens in STRUCT.findall(declarations)]
    types += ["type " + name for name in CALLBACK.findall(declarations)]
    if not types:
        return [words, "", *code]
    shown = code if "\n" in declarations else []
    lines = [f"::::{{c:{types[0]}".replace(" ", "} "), "", words, "", *shown, "::::", ""]
    return lines + [line for kind in types[1:] for line in (f"::::{{c:{kind}".replace(" ", "} "), "::::", "")]


def _words(comment: str) -> str:
    """The words of a comment in one line."""
    return " ".join(re.sub(r"^\s*\*? ?", "", line) for line in comment.strip().split("\n")).strip()


def _literal(text: str) -> str:
    """Words in which Markdown sees no markup but code between backquotes."""
    parts = re.split(r"(`[^`]+`)", " ".join(text.split()))
    return "".join(part if part.startswith("`") else re.sub(r"([\\*_$<\[\]{}|])", r"\\\1", part) for part in parts)


def _paragraphs(comment: str) -> list[str]:
    blocks = re.split(r"\n \*\n", comment)
    return [line for block in blocks for line in (_literal(_words(block)), "")]
