"""The report: one page with pictures and statements, and the numbers as CSV."""

from __future__ import annotations

import base64
import csv
import html
import io
from collections.abc import Mapping, Sequence
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np
from drawing import Drawn
from statements import Statement
from sweeps import COUPLINGS, Table, mean_of

import mfv

DPI = 110
STYLE = """
body { font-family: Georgia, serif; max-width: 75em; margin: 2em auto; padding: 0 1em;
  line-height: 1.4; color: #222; }
table { border-collapse: collapse; font-size: 0.9em; } td, th { border: 1px solid #ccc; padding: 0.3em 0.5em;
  vertical-align: top; }
th { text-align: left; background: #eee; } img { max-width: 100%; height: auto; } figure { margin: 2em 0; }
figcaption { font-size: 0.95em; color: #444; } .agrees { background: #e3f1ea; } .part { background: #fbf0d5; }
.differs { background: #f6ddd2; } .not { background: #e4edf6; }
"""
HEADINGS = ("section", "statement", "dissertation", "here", "verdict", "where it differs, why; otherwise a remark")


def picture_bytes(drawn: Drawn) -> bytes:
    """A picture as PNG, without a date or a version in it."""
    stream = io.BytesIO()
    drawn.picture.savefig(stream, dpi=DPI, metadata={"Software": None})
    return stream.getvalue()


def write_columns(path: Path, columns: Mapping[str, np.ndarray]) -> None:
    """Columns of one length as CSV."""
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(zip(*(plain(values) for values in columns.values())))


def plain(values: np.ndarray) -> list[str]:
    """Entries as text, numbers to ten digits."""
    return [f"{value:.10g}" if isinstance(value, float) else str(value) for value in values.tolist()]


def write_statements(path: Path, statements: Sequence[Statement]) -> None:
    """The statements as CSV."""
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow([field.name for field in fields(Statement)])
        writer.writerows(astuple(statement) for statement in statements)


def markdown(statements: Sequence[Statement]) -> str:
    """The statements as a table of a Markdown page."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "| --- " * len(HEADINGS) + "|"]
    lines += ["| " + " | ".join(text.replace("|", r"\|").replace("~", r"\~") for text in astuple(row)) + " |" for row in statements]
    return "\n".join(lines) + "\n"


def statements_table(statements: Sequence[Statement]) -> str:
    """The statements as HTML."""
    rows = ["<tr>" + "".join(f"<th>{html.escape(heading)}</th>" for heading in HEADINGS) + "</tr>"]
    for statement in statements:
        kind = statement.verdict.split()[-1] if "part" in statement.verdict else statement.verdict.split()[0]
        cells = "".join(f"<td>{html.escape(text)}</td>" for text in astuple(statement))
        rows.append(f'<tr class="{kind}">{cells}</tr>')
    return "<table>\n" + "\n".join(rows) + "\n</table>"


def cost_table(table: Table) -> str:
    """Linear solves of a case by coupling, as HTML."""
    rows = ["<tr><th>coupling</th><th>events</th><th>linear solves</th><th>in parts of full coupling</th></tr>"]
    full = mean_of(table.where(coupling="full"), "linear_solves")
    for name in COUPLINGS:
        part = table.where(coupling=name)
        solves = mean_of(part, "linear_solves")
        rows.append(
            f"<tr><td>{COUPLINGS[name]}</td><td>{mean_of(part, 'events'):.0f}</td><td>{solves:.0f}</td>"
            f"<td>{solves / full:.2f}</td></tr>"
        )
    return "<table>\n" + "\n".join(rows) + "\n</table>"


def counted(statements: Sequence[Statement]) -> str:
    """How many statements have which verdict."""
    verdicts = [statement.verdict for statement in statements]
    return ", ".join(f"{verdict}: {verdicts.count(verdict)}" for verdict in dict.fromkeys(verdicts)) + "."


def page(drawings: Sequence[Drawn], statements: Sequence[Statement], tables: Mapping[str, Table], quick: bool) -> str:
    """The whole page."""
    cases = sum(map(len, tables.values()))
    residual = max(float(np.nanmax(table["largest_residual"])) for table in tables.values())
    text = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8"><title>Elastic decoupling</title>',
        f"<style>{STYLE}</style></head><body>",
        "<h1>Elastic decoupling: chapter 6 of the dissertation, computed again</h1>",
        f"<p>MFV {html.escape(mfv.__version__)}, {cases} cases, largest relative residual of any {residual:.0e}."
        + (
            " A quick study: few values on every axis, coarse meshes, no remarks; its numbers are not those of the whole one."
            if quick
            else ""
        )
        + "</p>",
        "<h2>Statement by statement</h2>",
        f"<p>{html.escape(counted(statements))}</p>",
        statements_table(statements),
        "<h2>Cost of a case</h2>",
        f"<p>Means over the cases of Figure 6.3, meshes of {tables['lateral_force']['nodes'].max()} nodes, four cycles.</p>",
        cost_table(tables["lateral_force"]),
        "<h2>Pictures</h2>",
    ]
    for drawn in drawings:
        data = base64.b64encode(picture_bytes(drawn)).decode()
        caption = html.escape(drawn.caption)
        text.append(
            f'<figure><img alt="{drawn.name}" src="data:image/png;base64,{data}"><figcaption>{caption} '
            f"Numbers: {drawn.name}.csv.</figcaption></figure>"
        )
    return "\n".join([*text, "</body></html>", ""])
