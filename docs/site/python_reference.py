"""The reference of the Python package: a page for every module, filled by Sphinx from the docstrings."""

from __future__ import annotations

import ast
from pathlib import Path


def write_python_reference(package: Path, folder: Path) -> None:
    """Write python/index.md and a page for every public module below `folder`, the source of the site."""
    pages = folder / "python"
    pages.mkdir()
    paths = [
        path
        for pattern in ("*.py", "fatigue/*.py", "identify/*.py", "joint/*.py", "studies/*.py", "finite_elements/*.py")
        for path in package.glob(pattern)
        if not path.stem.startswith("_")
    ]
    modules = sorted(".".join(path.relative_to(package.parent).with_suffix("").parts) for path in paths)
    lines = ["# Python modules", "", *_module(package.name, ":no-members:"), "", "| module | what it is |", "| --- | --- |"]
    for name in modules:
        source = (package.parent / name.replace(".", "/")).with_suffix(".py").read_text()
        words = (ast.get_docstring(ast.parse(source)) or "").split("\n\n")[0]
        sentence = " ".join(words.split()).split(". ")[0].rstrip(".").replace("|", "\\|")
        lines.append(f"| [`{name}`]({name}.md) | {sentence} |")
        (pages / f"{name}.md").write_text("\n".join([f"# {name}", "", *_module(name), ""]))
    lines += ["", "```{toctree}", ":hidden:", "", *modules, "```", ""]
    (pages / "index.md").write_text("\n".join(lines))


def _module(name: str, *options: str) -> list[str]:
    return ["```{eval-rst}", f".. automodule:: {name}", *(f"   {option}" for option in options), "```"]
