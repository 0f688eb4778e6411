"""The reference of the C interface, from include/mfv.h: a comment, declarations below it, a blank line."""

from __future__ import annotations

import re
from pathlib import Path

from docstrings import escaped

PROTOTYPE = re.compile(r"^(?!typedef|enum|#)(\w[^;{}]*\([^;{}]*\));", re.MULTILINE)
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
            lines += _described(_words(comment[1]), block[comment.end():].strip())
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
    opaque = re.fullmatch(r"typedef struct (\w+) \1;", declarations)
    if opaque:
        return [*_directive("type", opaque[1]), "", words, ":::", ""]
    struct = re.match(r"typedef struct (\w+) \{(.*)\} \1;", declarations, re.DOTALL)
    if struct:
        members = re.findall(r"^ *(\w+ \w+); */\*(.*?)\*/", struct[2], re.MULTILINE | re.DOTALL)
        inner = []
        for name, meaning in members:
            inner += ["", *_directive("member", name), _literal(_words(meaning)), ":::"]
        return [*_directive("struct", struct[1], ":" * 4), "", words, *inner, "::::", ""]
    return [words, "", "```c", declarations, "```", ""]


def _directive(kind: str, signature: str, fence: str = ":::") -> list[str]:
    return [f"{fence}{{c:{kind}}} {signature}"]


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
