"""The notebooks of examples/notebooks: each is executed, and its outputs are the stored ones."""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from test_snippets import same_word

NOTEBOOKS = Path(__file__).resolve().parents[2] / "examples" / "notebooks"


def printed(notebook: nbformat.NotebookNode) -> list[str]:
    """What the cells print, one text a cell."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    return ["".join(output.text for output in cell.outputs if output.output_type == "stream") for cell in cells]


def pictures(notebook: nbformat.NotebookNode) -> int:
    """Number of pictures that the cells show."""
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    return sum("image/png" in output.get("data", {}) for output in outputs)


def words(text: str) -> list[str]:
    """The words of a text without punctuation."""
    return [word for word in re.split(r"[\s\[\],=:]+", text) if word]


@pytest.mark.parametrize("name", sorted(path.stem for path in NOTEBOOKS.glob("*.ipynb")))
def test_notebook_prints_what_it_shows(name: str) -> None:
    shown = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    run = nbformat.from_dict(shown)
    NotebookClient(run, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(NOTEBOOKS)}}).execute()
    assert pictures(run) == pictures(shown) > 0
    for before, after in zip(printed(shown), printed(run)):
        first, second = words(before), words(after)
        assert len(first) == len(second) and all(map(same_word, first, second)), f"shown:\n{before}\nprinted:\n{after}"


def test_every_notebook_is_listed() -> None:
    listed = re.findall(r"\]\((\w+)\.ipynb\)", (NOTEBOOKS / "README.md").read_text())
    assert sorted(listed) == sorted(path.stem for path in NOTEBOOKS.glob("*.ipynb"))
