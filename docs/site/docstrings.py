"""Sphinx extension: docstrings of this project are words with code between backquotes.

What else reStructuredText would see in them is taken literally.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx


def take_literally(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Escape what is markup outside of backquotes; keep indented lines, which are examples, as they stand."""
    text = "\n".join(lines)
    made: list[str] = []
    for block in re.split(r"\n{2,}", text.strip("\n")):
        rows = block.split("\n")
        if rows[0].startswith("    "):
            made += ["::", "", *rows, ""]
        else:
            words = block if block.lstrip().startswith("- ") else " ".join(row.strip() for row in rows)
            made += [*escaped(words).split("\n"), ""]
    lines[:] = made


def escaped(text: str) -> str:
    """Text whose only markup is code between backquotes."""
    parts = re.split(r"(`+[^`]+`+)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([\\*|_])", r"\\\1", part) for part in parts)


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("autodoc-process-docstring", take_literally)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
