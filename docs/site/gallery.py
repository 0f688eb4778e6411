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
from matplotlib.figure import Figure

import mfv

THUMBNAIL_WIDTH = 480
GRID = ["::::{grid} 1 2 2 3", ":gutter: 3", ""]


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
    """Write gallery/index.md and a page for every example below `folder`, the source of the site, in a folder for each sort.

    root: the repository; programs: folder of mfv_run; show: told of every case that is solved.
    Returns the page of each example file, both relative: files to the repository, pages to the source.
    """
    gallery = folder / "gallery"
    places = {name: gallery / name for name in ("examples", "scripts", "dissertation", "decoupling")}
    for place in places.values():
        place.mkdir(parents=True)
    solved = _solved(root, programs, places["examples"], show)
    scripts = _scripts(root, places["scripts"])
    figures = _dissertation(root, places["dissertation"])
    sections = [
        ("Examples", "Solved and drawn while this site was built.", "examples", solved),
        ("Scripts", "Python programs that solve many cases.", "scripts", scripts),
        ("Figures of the dissertation", "Drawn by `examples/dissertation/draw.py`.", "dissertation", figures),
    ]
    lines = ["# Gallery", ""]
    made = {}
    for heading, words, place, entries in sections:
        lines += [f"## {heading}", "", words, "", *GRID]
        for entry in entries:
            lines += _card(entry, places[place])
            # The side bar has room for the examples; the others are found from here.
            mark = "" if place == "examples" else "---\norphan: true\n---\n\n"
            (places[place] / f"{entry.name}.md").write_text(mark + _page(root, entry))
            made[entry.source.relative_to(root)] = f"gallery/{place}/{entry.name}.md"
        lines += ["::::", ""]
    lines += _decoupling(root, places["decoupling"])
    lines += ["```{toctree}", ":hidden:", "", *(f"examples/{entry.name}" for entry in solved), "```", ""]
    (gallery / "index.md").write_text("\n".join(lines))
    return made


def _solved(root: Path, programs: Path, pages: Path, show: object) -> list[Entry]:
    entries = []
    for source in sorted((root / "examples").glob("*.nml")):
        text = source.read_text()
        if "&sweep" in text.lower():  # no case: a study of several
            continue
        show(f"  {source.name}")
        run = subprocess.run([programs / "mfv_run", source], cwd=pages, check=False, capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{source}: mfv_run ended with exit code {run.returncode}: {run.stderr}")
        result = re.search(r"^result +(\S+\.h5)", run.stdout, re.MULTILINE)[1]
        picture = f"{source.stem}.png"
        solved = mfv.read(pages / result)
        _save(mfv.plot.figure(solved), pages / picture)
        _save(_small_figure(solved), _place_of_thumbnail(pages / picture))
        (pages / result).unlink()
        commands = f"mfv run {source.name}\nmfv plot {result} -o {picture}"
        title, sentence = _words(text, source.stem)
        entries.append(Entry(source, title, sentence, commands, picture, run.stdout))
    return entries


def _save(figure: Figure, path: Path) -> None:
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _small_figure(result: mfv.Result) -> Figure:
    """The traction that a case is about: shear where there is any, else pressure."""
    figure, axes = plt.subplots(figsize=(4.4, 3.0), layout="constrained")
    draw = mfv.plot.shear if "shear" in result.state and result.state.shear.any() else mfv.plot.pressure
    draw(result, axes)
    axes.set_title("")
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
        entries.append(Entry(source, title, sentence, commands, picture.name))
    return entries


def _decoupling(root: Path, pages: Path) -> list[str]:
    """The section of the decoupling study: its pictures, copied into `pages`, which lead to its document."""
    study = "../examples/decoupling"
    words = f"[what came out]({study}/README.md), [statement by statement]({study}/statements.md)."
    lines = ["## The decoupling study", "", f"Chapter 6 computed again, some 4,600 cases: {words}", "", *GRID]
    for picture in sorted((root / "examples/decoupling/pictures").glob("*.png")):
        shutil.copy(picture, pages)
        title = re.sub(r"^figure (\d+) (\d+)$", r"figure \1.\2", picture.stem.replace("_", " ")).capitalize()
        _thumbnail(pages / picture.name)
        lines += _framed(title, "", f"{study}/README", f"{pages.name}/{picture.name}", title)
    return [*lines, "::::", ""]


def _words(text: str, name: str) -> tuple[str, str]:
    """Title of a case, and the first sentence of the comment that it begins with."""
    comment = re.match(r"(?:!.*\n)*", text)[0]
    words = re.sub(r"^Figure \d+\.\d+: ", "", " ".join(line.lstrip("! ") for line in comment.splitlines()))
    title = re.search(r"\btitle *= *(['\"])(.*?)\1", text, re.IGNORECASE)
    return title[2] if title else name.replace("_", " ").capitalize(), _first_sentence(words)


def _first_sentence(words: str) -> str:
    sentence = re.split(r"(?<=[\w)\]]\.)(?<!\beq\.)(?<!\beqs\.) (?=[A-Z0-9&])", words, maxsplit=1)[0]
    return sentence[:1].upper() + sentence[1:]


def _card(entry: Entry, pages: Path) -> list[str]:
    picture = pages / entry.picture
    if entry.picture and not _place_of_thumbnail(picture).exists():
        _thumbnail(picture)
    shown = f"{pages.name}/{entry.picture}" if entry.picture else ""
    return _framed(entry.title, _literal(entry.sentence), f"{pages.name}/{entry.name}", shown, entry.title)


def _framed(title: str, words: str, link: str, picture: str, alternative: str) -> list[str]:
    shown = [f":img-top: {_place_of_thumbnail(Path(picture))}", f":img-alt: {alternative}"] if picture else []
    return [f":::{{grid-item-card}} {_literal(title)}", f":link: {link}", ":link-type: doc", *shown, "", words, ":::", ""]


def _place_of_thumbnail(picture: Path) -> Path:
    return picture.with_name(f"thumbnail_{picture.name}")


def _thumbnail(picture: Path) -> None:
    """A small copy of a picture beside it."""
    width = matplotlib.image.imread(picture).shape[1]
    matplotlib.image.thumbnail(str(picture), str(_place_of_thumbnail(picture)), scale=min(1.0, THUMBNAIL_WIDTH / width))


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
