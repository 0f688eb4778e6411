"""What notebooks show: small tables as HTML."""

from __future__ import annotations

import html
from collections.abc import Collection, Iterable, Sequence

CELL = "text-align:left; padding:1px 10px 1px 0; vertical-align:top"
NUMBER = "text-align:right; padding:1px 10px 1px 0; vertical-align:top; font-variant-numeric:tabular-nums"


def table(rows: Iterable[Sequence[str]], caption: str = "", numbers: Collection[int] = ()) -> str:
    """A table whose first column has names; `numbers`: columns that are numbers."""
    lines = ["<tr>" + "".join(_cell(text, column, column in numbers) for column, text in enumerate(row)) + "</tr>" for row in rows]
    head = f"<caption style='text-align:left; font-weight:bold'>{html.escape(caption)}</caption>" if caption else ""
    return f"<table style='border-collapse:collapse; margin:4px 0; color:inherit; font-size:inherit'>{head}{''.join(lines)}</table>"


def unit(name: str) -> str:
    """A unit as it is shown: nothing for a pure number."""
    return "" if name == "1" else name


def _cell(text: str, column: int, is_number: bool) -> str:
    kind = "th" if column == 0 else "td"
    return f"<{kind} style='{NUMBER if is_number else CELL}'>{html.escape(text)}</{kind}>"
