"""Stage the pages of the site: the repository's Markdown files as they are, with links that Sphinx follows, and pages made from
examples, programs, header and sources.

    python docs/site/stage.py --programs build/release/bin build/docs/source
"""

from __future__ import annotations

import argparse
import base64
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "python")]

from c_reference import write_c_reference
from check_links import MARKDOWN_LINK, WEB, markdown_files
from fortran_reference import write_fortran_reference
from gallery import write_gallery
from python_reference import write_python_reference

from mfv.commands import COMMANDS

PROGRAMS = ("mfv_run", "mfv_stress", "mfv_conventional")
PICTURES = (".png", ".gif", ".svg", ".jpg")
LANGUAGES = {".nml": "fortran", ".f90": "fortran", ".F90": "fortran", ".py": "python", ".h": "c", ".def": "c", ".c": "c"}
LANGUAGES |= {".sh": "sh", ".cff": "yaml", ".toml": "toml"}
# Files that the page of a folder names.
SHOWN = (*PICTURES, *LANGUAGES, ".csv", ".md", ".txt")
# Pages of the side bar by heading, as they are staged; pages that are not there yet are omitted.
CONTENTS = {
    "Start": [
        "docs/install",
        "docs/tutorial",
        "docs/guide",
        "gallery/index",
        "Notebooks <examples/notebooks/README>",
        "docs/choosing",
    ],
    "Reference": ["docs/namelist", "docs/studies", "docs/file-format", "programs"],
    "Applications": ["docs/pad_to_life", "docs/from_fe", "docs/fe_to_life", "docs/joints", "docs/identify", "docs/fatigue"],
    "Interfaces": ["docs/python-api", "python/index", "docs/c-api", "c", "docs/fortran-api", "fortran/index"],
    "Background": [
        "docs/theory",
        "docs/architecture",
        "docs/verification",
        "docs/trust",
        "docs/performance",
        "The decoupling study <examples/decoupling/README>",
    ],
    "Project": ["CHANGELOG", "CONTRIBUTING", "SECURITY", "docs/releasing"],
}
# Read in the repository only: what the site says by other pages.
LEFT_OUT = ("python/README.md", "python/mfv/templates/keys.md")


def main() -> int:
    parser = argparse.ArgumentParser(description="Stage the pages of the site.")
    parser.add_argument("folder", type=Path, help="where they go; what is there already is removed")
    parser.add_argument("--programs", type=Path, default=ROOT / "build/release/bin", help="folder of mfv_run and the others")
    arguments = parser.parse_args()
    programs, folder = arguments.programs.resolve(), arguments.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_c_reference(ROOT / "include", folder / "c.md")
    write_fortran_reference(ROOT, folder)
    write_python_reference(ROOT / "python/mfv", folder)
    write_programs(programs, folder / "programs.md")
    examples = write_gallery(ROOT, programs, folder, lambda text: print(text, flush=True))
    Site(folder, examples).stage(markdown_files())
    return 0


def write_programs(programs: Path, page: Path) -> None:
    """The page of the programs' --help."""
    lines = [
        "# Programs",
        "",
        "What `--help` says; `mfv run` is mfv_run, `mfv stress` is mfv_stress. The manual pages, `man mfv_run`",
    ]
    lines += ["and so on, have the same, and every key of a case in `man 5 mfv_case`. Options, files and quantities are"]
    lines += ["completed by bash, zsh and fish.", ""]
    commands = {program: [programs / program] for program in PROGRAMS}
    others = [each.NAME for each in COMMANDS if not hasattr(each, "PROGRAM")]  # mfv run and mfv stress are programs
    commands |= {f"mfv {name}": [sys.executable, "-m", "mfv", name] for name in others}
    surroundings = os.environ | {"PYTHONPATH": str(ROOT / "python"), "COLUMNS": "100"}
    for name, command in commands.items():
        shown = subprocess.run([*command, "--help"], check=True, capture_output=True, text=True, env=surroundings)
        lines += [f"## {name}", "", "```text", shown.stdout.rstrip(), "```", ""]
    page.write_text("\n".join(lines))


class Site:
    """Staged pages below `folder`. pages: those of files that have one already, both paths relative."""

    def __init__(self, folder: Path, pages: dict[Path, str]) -> None:
        self.folder = folder
        self.pages = dict(pages)
        self.made = set(pages.values())
        self.files: list[str] = []

    def stage(self, documents: list[Path]) -> None:
        documents = [path for path in documents if str(path.relative_to(ROOT)) not in LEFT_OUT]
        for path in documents:
            relative = path.relative_to(ROOT)
            self.pages[relative] = "index.md" if str(relative) == "README.md" else str(relative)
        for path in documents:
            self._write(self.pages[path.relative_to(ROOT)], self._with_links(path, path.read_text()))
        self._add_contents(sorted(page.removesuffix(".md") for page in self.pages.values() if page.endswith(".md")))

    def _write(self, page: str, text: str) -> None:
        path = self.folder / page
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def _with_links(self, path: Path, text: str) -> str:
        """The text of a document with its links turned to staged pages. Links within code are none."""
        here = Path(self.pages[path.relative_to(ROOT)]).parent
        pieces = []
        for number, piece in enumerate(_around_code(text)):
            if number % 2 == 0:
                piece = MARKDOWN_LINK.sub(lambda match: f"{match[1]}({self._target(path, here, match[2])})", piece)
            pieces.append(piece)
        return "".join(pieces)

    def _target(self, path: Path, here: Path, link: str) -> str:
        if WEB.match(link) or link.startswith("#"):
            return link
        file, mark, anchor = link.partition("#")
        target = Path(os.path.normpath(path.parent / file)).relative_to(ROOT)
        page = self.pages.get(target) or self._page_of(target)
        return os.path.relpath(page, here) + mark + anchor

    def _page_of(self, target: Path) -> str:
        """Page of a file or folder that is no document: a picture is copied, another file shown, a folder listed."""
        source = ROOT / target
        if not source.exists():
            raise FileNotFoundError(f"a document links to {target}, which is not there: python3 scripts/check_links.py names it")
        if source.suffix in PICTURES:
            copy = self.folder / target
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
            return str(target)
        page = f"files/{target}.md"
        self.pages[target] = page
        self.files.append(page.removesuffix(".md"))
        here = Path(page).parent
        if source.is_dir():
            lines = [f"# {target}", ""]
            for name in sorted(path.name for path in source.iterdir() if path.suffix in SHOWN):
                link = os.path.relpath(self.pages.get(target / name) or self._page_of(target / name), here)
                lines += [f"![{name}]({link})", ""] if Path(name).suffix in PICTURES else [f"- [{name}]({link})"]
        elif source.suffix == ".ipynb":
            lines = self._with_links(source, "\n".join(self._notebook(source, page))).splitlines()
        else:
            lines = [f"# {target}", "", f"```{LANGUAGES.get(source.suffix, 'text')}", source.read_text().rstrip(), "```"]
        self._write(page, "\n".join(lines) + "\n")
        return page

    def _notebook(self, source: Path, page: str) -> list[str]:
        """The cells of a notebook with their output; pictures are put beside the page."""
        lines: list[str] = []
        for number, cell in enumerate(json.loads(source.read_text())["cells"]):
            text = "".join(cell["source"])
            lines += [text, ""] if cell["cell_type"] == "markdown" else ["```python", text, "```", ""]
            for output in cell.get("outputs", []):
                if "text" in output:
                    lines += ["```text", "".join(output["text"]).rstrip(), "```", ""]
                elif "image/png" in output["data"]:
                    picture = source.with_name(f"{source.stem}_{number}.png").relative_to(ROOT)
                    (self.folder / picture).parent.mkdir(parents=True, exist_ok=True)
                    (self.folder / picture).write_bytes(base64.b64decode(output["data"]["image/png"]))
                    self.pages[picture] = str(picture)
                    lines += [f"![Output of the cell above]({picture.name})", ""]
        return lines

    def _add_contents(self, documents: list[str]) -> None:
        """The side bar: headings with their pages, then documents that no heading names, hidden."""
        lines, named = [], {"index"}
        for heading, pages in CONTENTS.items():
            there = [page for page in pages if (self.folder / f"{_name(page)}.md").exists()]
            named.update(map(_name, there))
            lines += ["", "```{toctree}", ":hidden:", f":caption: {heading}", "", *there, "```"]
        rest = [page for page in documents + self.files if page not in named and f"{page}.md" not in self.made]
        front = self.folder / "index.md"
        front.write_text(front.read_text() + "\n".join(lines) + "\n")
        for page in dict.fromkeys(rest):
            path = self.folder / f"{page}.md"
            path.write_text("---\norphan: true\n---\n\n" + path.read_text())


def _name(entry: str) -> str:
    """The page of an entry of the side bar, which may have a title before it."""
    return entry.partition("<")[2].removesuffix(">") or entry


def _around_code(text: str) -> list[str]:
    """A Markdown text cut into words and code, in turn."""
    pieces, code, fence = [""], False, ""
    for line in text.splitlines(keepends=True):
        opens = line.lstrip().startswith("```")
        if opens and not code:
            pieces.append("")
            code, fence = True, line.lstrip()[:3]
            pieces[-1] += line
        elif code and line.lstrip().startswith(fence):
            pieces[-1] += line
            pieces.append("")
            code = False
        else:
            pieces[-1] += line
    return pieces


if __name__ == "__main__":
    sys.exit(main())
