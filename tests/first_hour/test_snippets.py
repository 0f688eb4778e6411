"""Snippets of the pages: every case and command runs as printed, and the printed output is the actual one.

A page is read from top to bottom in one folder, which has the examples. A namelist block with bodies becomes case.nml (a block with
`&sweep` study.nml) and is run; a block without bodies is put into the last case of the page, its steps behind those of the case.
Indented lines that begin with a program are given to a shell, with what the page has exported before; other indented lines are output of
what ran since the output before. README, tutorial and the others run with what scripts/demo.sh has built (.ci/run).
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
PAGES = (
    "README.md",
    "docs/tutorial.md",
    "docs/c-api.md",
    "docs/fatigue.md",
    "docs/fe_to_life.md",
    "docs/from_fe.md",
    "docs/guide.md",
    "docs/identify.md",
    "docs/joints.md",
    "docs/namelist.md",
    "docs/pad_to_life.md",
)
#: Pages whose Python blocks print what is shown below them; those of other pages are run by tests/python/test_docs.py.
PYTHON_PAGES = ("README.md", "docs/tutorial.md", "docs/fatigue.md", "docs/from_fe.md", "docs/identify.md", "docs/joints.md")
COMPLETE, ENDED_EARLY = 0, 3
#: Commands that the scripts of CI run themselves, that install, or that take minutes.
NOT_RUN = re.compile(r"git clone|sh scripts/|cmake |pip |.*pip install|man |.*examples/dissertation/draw.py")
COMMAND = re.compile(r"(mfv|mfv_\w+|python|printf|test|cc) (?=\S)|\./\w+$")
#: Residuals at the level of round-off depend on the processor; times on the day.
ROUND_OFF = 1.0e-11


class Reader:
    """Follows a page: `folder` is where its cases and commands are run."""

    def __init__(self, page: str, folder: Path) -> None:
        self.page = page
        self.folder = folder
        self.case = ""
        self.printed: list[str] = []
        self.fresh = True
        self.exports: list[str] = []
        shutil.copytree(PROJECT / "examples", folder / "examples", ignore=shutil.ignore_patterns("*.h5", "pictures"))
        for place in ("include", "build/release"):
            (folder / place).parent.mkdir(exist_ok=True)
            (folder / place).symlink_to(PROJECT / place)
        (folder / "build/venv").symlink_to(sys.prefix)

    def read(self) -> None:
        block: list[str] = []
        kind = ""
        for number, line in enumerate((PROJECT / self.page).read_text().splitlines(), 1):
            place = f"{self.page}:{number}"
            if line.startswith("```"):
                if kind == "fortran" and block and block[0].startswith("&"):
                    self.run_case("\n".join(block) + "\n", place)
                elif kind == "python" and self.page in PYTHON_PAGES:
                    (self.folder / "script.py").write_text("\n".join(block) + "\n")
                    self.run("python script.py", place)
                kind, block = (line[3:] or "other", []) if not kind else ("", [])
            elif kind:
                block.append(line)
            elif line.startswith("    ") and line.strip():
                self.indented(line[4:], place)

    def run_case(self, text: str, place: str) -> None:
        name = "study.nml" if text.startswith("&sweep") else "case.nml"
        if name == "case.nml":
            text = self.case = text if "&body" in text else merged(self.case, text)
        (self.folder / name).write_text(text)
        if name == "case.nml":
            self.run(f"mfv run {name}", place)

    def indented(self, line: str, place: str) -> None:
        if NOT_RUN.match(line):
            return
        if line.startswith("export "):
            self.exports.append(line.split("  #")[0])
        elif COMMAND.match(line):
            self.run(line, place)
        else:
            self.compare(line, place)

    def run(self, command: str, place: str) -> None:
        """Run it and save its output. The page must show the message of a failure."""
        if self.fresh:
            self.printed = []
            self.fresh = False
        script = "\n".join(["set -e", *(self.exports or ['export PATH="$PWD/build/venv/bin:$PATH"']), command])
        result = subprocess.run(script, shell=True, cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.printed += result.stdout.splitlines() + result.stderr.splitlines()
        if result.returncode not in (COMPLETE, ENDED_EARLY):
            text = (PROJECT / self.page).read_text()
            assert result.stderr.strip() and result.stderr.strip().splitlines()[0] in text, f"{place}: {result.stderr}"

    def compare(self, line: str, place: str) -> None:
        self.fresh = True
        assert any(same_output(line, printed) for printed in self.printed), f"{place}: not printed:\n{line}\nbut\n" + "\n".join(
            self.printed
        )


def merged(case: str, fragment: str) -> str:
    """The case with the groups of a fragment in place of its own; steps are added."""
    named = {name for name in re.findall(r"^&(\w+)", fragment, re.MULTILINE) if name != "step"}
    kept = [line for line in case.splitlines() if not (found := re.match(r"&(\w+)", line)) or found[1] not in named]
    return "\n".join(kept) + "\n" + fragment


def same_output(shown: str, printed: str) -> bool:
    """Whether the lines agree but for times, and for residuals at the level of round-off."""
    times = re.compile(r"\S+ s$|\S+ s(?=[ ,])")
    first, second = (times.sub("# s", line).replace(",", " ,").split() for line in (shown, printed))
    return len(first) == len(second) and all(map(same_word, first, second))


def same_word(shown: str, printed: str) -> bool:
    if shown == printed:
        return True
    try:
        one, other = float(shown), float(printed)
    except ValueError:
        return False
    return abs(one - other) <= 1.0e-5 * abs(one) or max(abs(one), abs(other)) < ROUND_OFF


@pytest.mark.parametrize("page", PAGES)
def test_cases_commands_and_output_of_a_page(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MPLBACKEND", "Agg")
    reader = Reader(page, tmp_path)
    reader.read()
    assert reader.case or reader.printed


def test_output_that_differs_is_found() -> None:
    line = "work                0 events, 1 linear solve (reduced), 0.0026 s"
    assert same_output(line, line.replace("0.0026", "1.5"))
    assert not same_output(line, line.replace("0 events", "1 events"))
    assert same_output("largest relative residual 7.7e-16", "largest relative residual 3e-15")
    assert not same_output("largest relative residual 7.7e-16", "largest relative residual 3e-9")
    assert not same_output("half-width 0.127335 mm", "half-width 0.127435 mm")
