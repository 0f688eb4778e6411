"""Pages of the gallery: examples solved and drawn, the dissertation's figures and the decoupling study from their pictures."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import matplotlib.image

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import mfv

THUMBNAIL_WIDTH = 480


@dataclass
class Entry:
    """One example: where it lies in the repository, what it is, how it is run, its picture beside the page (or none)."""

    source: Path
    title: str
    sentence: str
    commands: str
    picture: str = ""
    summary: str = ""

    @property
    def name(self) -> str:
        return self.source.stem


def write_gallery(root: Path, programs: Path, folder: Path, show: object = print) -> dict[Path, str]:
    """Write gallery/index.md and a page for every example below `folder`, the source of the site.

    root: the repository; programs: folder of mfv_run and mfv_sweep; show: told of every case that is solved.
    Returns the page of each example file, both relative: files to the repository, pages to the source.
    """
    pages = folder / "gallery"
    pages.mkdir(parents=True)
    sections = [
        ("Examples", "Solved and drawn while this site was built.", _solved(root, programs, pages, show)),
        ("Scripts", "Python programs that solve many cases.", _scripts(root, pages)),
        ("Figures of the dissertation", "Drawn by `examples/dissertation/draw.py`.", _dissertation(root, pages)),
    ]
    lines = ["# Gallery", ""]
    for heading, words, entries in sections:
        lines += [f"## {heading}", "", words, "", "::::{grid} 1 2 2 3", ":gutter: 3", ""]
        for entry in entries:
            lines += _card(entry, pages)
            (pages / f"{entry.name}.md").write_text(_page(root, entry))
        lines += ["::::", ""]
    lines += _decoupling(root, pages)
    everything = [entry for _, _, entries in sections for entry in entries]
    lines += ["```{toctree}", ":hidden:", "", *(entry.name for entry in everything), "```", ""]
    (pages / "index.md").write_text("\n".join(lines))
    return {entry.source.relative_to(root): f"gallery/{entry.name}.md" for entry in everything}


def _solved(root: Path, programs: Path, pages: Path, show: object) -> list[Entry]:
    entries = []
    for source in sorted((root / "examples").glob("*.nml")):
        show(f"  {source.name}")
        text = source.read_text()
        is_sweep = "&sweep" in text.lower()
        program = "mfv_sweep" if is_sweep else "mfv_run"
        run = subprocess.run([programs / program, source], cwd=pages, capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{source}: {program} ended with exit code {run.returncode}: {run.stderr}")
        result = re.search(r"^(?:result|table) +(\S+\.h5)", run.stdout, re.MULTILINE)[1]
        picture = f"{source.stem}.png"
        figure = _table_figure(pages / result) if is_sweep else mfv.plot.figure(mfv.read(pages / result))
        figure.savefig(pages / picture, dpi=110)
        plt.close(figure)
        command = f"python -m mfv table {result}" if is_sweep else f"python -m mfv plot {result} -o {picture}"
        title, sentence = _words(text, source.stem)
        entries.append(Entry(source, title, sentence, f"{program} {source.name}\n{command}", picture, run.stdout))
    return entries


def _table_figure(path: Path) -> plt.Figure:
    """Dissipation of a cycle in a table over its last varied number, a curve for each combination of the others."""
    table = mfv.read_table(path)
    names = list(table.dtype.names)
    varied = [name for name in names[2:names.index("outcome")] if len(set(table[name])) > 1]
    across = [name for name in varied if table[name].dtype.kind == "f"][-1]
    others = [name for name in varied if name != across]
    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    for values in sorted({tuple(row[name] for name in others) for row in table}):
        rows = [row for row in table if tuple(row[name] for name in others) == values]
        label = ", ".join(f"{name.split('%')[-1]} {value}" for name, value in zip(others, values))
        axes.plot([row[across] for row in rows], [row["cycle_dissipation"] for row in rows], "o-", markersize=3, label=label)
    axes.set_xlabel(across)
    axes.set_ylabel("cycle_dissipation")
    axes.set_yscale("log")
    axes.legend(fontsize="x-small")
    return figure


def _scripts(root: Path, pages: Path) -> list[Entry]:
    entries = []
    for source in sorted((root / "examples").glob("*.py")):
        title, sentence = _of_docstring(source)
        picture = root / f"docs/pictures/{source.name.replace('.py', '.png')}"
        name = Path(shutil.copy(picture, pages)).name if picture.exists() else ""
        entries.append(Entry(source, title, sentence, f"python examples/{source.name}", name))
    return entries


def _of_docstring(source: Path) -> tuple[str, str]:
    """Title and first sentence of a script."""
    words = " ".join(ast.get_docstring(ast.parse(source.read_text())).split("\n\n")[0].split())
    return source.stem.replace("_", " ").capitalize(), _first_sentence(words)


def _dissertation(root: Path, pages: Path) -> list[Entry]:
    entries = []
    for source in sorted((root / "examples/dissertation").glob("*.nml")):
        title, sentence = _words(source.read_text(), source.stem)
        picture = root / f"examples/dissertation/pictures/{source.stem}.png"
        shutil.copy(picture, pages)
        commands = f"python examples/dissertation/draw.py --help\nmfv_run examples/dissertation/{source.name}"
        entries.append(Entry(source, title, re.sub(r"^Figure \d+\.\d+: ", "", sentence), commands, picture.name))
    return entries


def _decoupling(root: Path, pages: Path) -> list[str]:
    """The section of the decoupling study: its pictures, which lead to its document."""
    lines = ["## The decoupling study", "", "Chapter 6 of the dissertation computed again, some 4,600 cases:",
             "[what came out](../examples/decoupling/README.md), [statement by statement](../examples/decoupling/statements.md).",
             "", "::::{grid} 1 2 2 3", ":gutter: 3", ""]
    for picture in sorted((root / "examples/decoupling/pictures").glob("*.png")):
        shutil.copy(picture, pages)
        title = re.sub(r"^figure (\d+) (\d+)$", r"figure \1.\2", picture.stem.replace("_", " ")).capitalize()
        lines += _framed(title, "", "../examples/decoupling/README", _thumbnail(pages / picture.name), title)
    return [*lines, "::::", ""]


def _words(text: str, name: str) -> tuple[str, str]:
    """Title of a case, and the first sentence of the comment that it begins with."""
    comment = re.match(r"(?:!.*\n)*", text)[0]
    words = " ".join(line.lstrip("! ") for line in comment.splitlines())
    title = re.search(r"\btitle *= *(['\"])(.*?)\1", text, re.IGNORECASE)
    return title[2] if title else name.replace("_", " ").capitalize(), _first_sentence(words)


def _first_sentence(words: str) -> str:
    return re.split(r"(?<=[\w)\]]\.) (?=[A-Z0-9&])", words, maxsplit=1)[0]


def _card(entry: Entry, pages: Path) -> list[str]:
    thumbnail = _thumbnail(pages / entry.picture) if entry.picture else ""
    return _framed(entry.title, _literal(entry.sentence), entry.name, thumbnail, entry.title)


def _framed(title: str, words: str, link: str, thumbnail: str, alternative: str) -> list[str]:
    picture = [f":img-top: {thumbnail}", f":img-alt: {alternative}"] if thumbnail else []
    return [f":::{{grid-item-card}} {_literal(title)}", f":link: {link}", ":link-type: doc", *picture, "", words, ":::", ""]


def _thumbnail(picture: Path) -> str:
    name = f"thumbnail_{picture.name}"
    width = matplotlib.image.imread(picture).shape[1]
    matplotlib.image.thumbnail(str(picture), str(picture.with_name(name)), scale=min(1.0, THUMBNAIL_WIDTH / width))
    return name


def _page(root: Path, entry: Entry) -> str:
    language = "python" if entry.source.suffix == ".py" else "fortran"
    source = entry.source.read_text()
    lines = [f"# {_literal(entry.title)}", "", f"{_literal(entry.sentence)}", "", "```sh", entry.commands, "```", ""]
    if entry.picture:
        lines += [f"![{entry.title}]({entry.picture})", ""]
    if entry.summary:
        lines += ["```text", entry.summary.rstrip(), "```", ""]
    lines += [f"`{entry.source.relative_to(root)}`:", "", f"```{language}", source.rstrip(), "```", ""]
    return "\n".join(lines)


def _literal(text: str) -> str:
    """Words in which Markdown sees no markup."""
    return re.sub(r"([\\*_$<\[\]{}])", r"\\\1", text)
