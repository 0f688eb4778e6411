"""The examples of the documents: every Python block of a page is run, one after the other, in a directory with the examples."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import xarray
from matplotlib import pyplot
from scenes import PROJECT

import mfv

PAGES = ("docs/python-api.md", "docs/studies.md", "python/README.md")


@pytest.fixture
def directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the examples are run: with the project's examples, and a case."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(PROJECT / "examples")
    (tmp_path / "case.nml").write_text((PROJECT / "examples" / "mindlin.nml").read_text())
    return tmp_path


def blocks(page: str) -> list[tuple[int, str]]:
    """The Python blocks of a page, each with the number of its first line."""
    text = (PROJECT / page).read_text()
    return [
        (text[: m.start(1)].count("\n") + 1, m[1]) for m in re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    ]


@pytest.mark.parametrize("page", PAGES)
def test_the_examples_of_a_page_run(page: str, directory: Path) -> None:
    found = blocks(page)
    assert found
    names: dict[str, object] = {}
    for line, code in found:
        # Blank lines before it: a traceback then has the line of the page.
        exec(compile("\n" * (line - 1) + code, str(PROJECT / page), "exec"), names)
    pyplot.close("all")
    assert any(isinstance(value, (mfv.Result, xarray.Dataset)) for value in names.values())


def test_the_limits_of_the_linear_solvers_are_those_of_the_source() -> None:
    """The table of docs/performance.md has the numbers of solver_costs.f90, chosen as linear_solvers.f90 does."""
    source = (PROJECT / "src/algorithms/solvers/solver_costs.f90").read_text()
    limits = {name: int(number) for name, number in re.findall(r"\b(most_\w+) = (\d+)", source)}
    table = {
        "events": ("most_coupled", "most_one_way", "most_apart"),
        "large increments, no friction": ("most_at_once_coupled", "most_at_once", "most_at_once"),
        "Dahl's law": ("most_bristles_coupled", "most_bristles", "most_bristles"),
    }
    page = (PROJECT / "docs/performance.md").read_text()
    for name, columns in table.items():
        assert f"| {name} | {' | '.join(str(limits[column]) for column in columns)} |" in page
