"""What docs/install.md and the messages say about installing: commands as printed, names of packages."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mfv import _packages

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
import requirements

PROJECT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("MFV_RUN", PROJECT / "build/release/bin/mfv_run")).parents[1]
DECLARED = requirements.tomllib.loads((PROJECT / "pyproject.toml").read_text())["project"]


def package(requirement: str) -> str:
    """The name of the package of a requirement."""
    return re.split(r"[\[<>=;, ]", requirement)[0]


def tracked_texts() -> dict[str, str]:
    """The texts of the repository that a user may read, by path."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=PROJECT, capture_output=True, text=True, check=True).stdout.split("\0")
    kinds = (".md", ".py", ".f90", ".sh", ".nml", ".ipynb", ".toml", ".html", ".1", ".5")
    return {name: (PROJECT / name).read_text() for name in listed if name.endswith(kinds) and (PROJECT / name).is_file()}


def test_no_line_installs_the_package_of_somebody_else() -> None:
    """mfv on PyPI is not this project: extras are those of the source tree or of the distribution's own name."""
    assert DECLARED["name"] != "mfv"
    own, extras = DECLARED["name"], DECLARED["optional-dependencies"]
    found = 0
    for name, text in tracked_texts().items():
        for what in re.findall(r"""pip install [^\n]*?['"]([^'"\n]+\[[^'"\n]+)['"]""", text):
            before, _, named = what.partition("[")
            if name == Path(__file__).relative_to(PROJECT).as_posix() or before in ("dask",):
                continue
            found += 1
            assert before in (".", own), f"{name}: {what}"
            assert set(named.rstrip("]").split(",")) <= set(extras), f"{name}: {what}"
        for what in re.findall(r"""pip install (?:-\S+ )*['"]?(mfv\b[^*\s]*)""", text):
            assert what.startswith(own), f"{name}: {what}"
    assert found > 5
    for requirement in (line for lines in extras.values() for line in lines):
        assert package(requirement) != "mfv"


def test_messages_install_the_packages_of_an_extra() -> None:
    """Packages that a message names together are those of one extra, or those that the package needs itself."""
    base = {package(line) for line in DECLARED["dependencies"]}
    known = [
        base,
        *({package(line) for line in requirements.of_extra(DECLARED, extra)} for extra in DECLARED["optional-dependencies"]),
    ]
    for group in _packages.TOGETHER:
        assert any(set(group) - {"distributed"} <= names for names in known), group


@pytest.mark.parametrize(
    ("blocked", "script"),
    [
        ("xarray", "import mfv; mfv.read('{h5}').state.to_xarray()"),
        ("xarray", "import mfv; mfv.study('{nml}', {{'friction%mu': [0.5]}}).run()"),
        ("threadpoolctl", "from mfv.studies.cases import one_blas_thread; one_blas_thread()"),
        ("plotly", "from mfv.report import page"),
        ("jinja2", "from mfv import report"),
        ("scipy", "import mfv.fatigue.lives as lives; lives.needed('scipy.optimize')"),
        ("mpi4py", "from mfv.studies.executors import opened; opened('mpi', 2).__enter__()"),
        ("dask", "from mfv.studies.executors import opened; opened('dask', 2).__enter__()"),
    ],
)
def test_a_missing_package_is_named_with_the_line_that_installs_it(blocked: str, script: str, tmp_path: Path) -> None:
    """In Python the last line of the traceback says it; `import xarray` alone would say "No module named 'xarray'"."""
    subprocess.run([BUILD / "bin/mfv_run", PROJECT / "examples/mindlin.nml"], cwd=tmp_path, capture_output=True, check=True)
    hide = (
        "import importlib.util as u, sys; find = u.find_spec\n"
        f"hidden = lambda name, *more: None if name.split('.')[0] == '{blocked}' else find(name, *more)\n"
        f"u.find_spec = hidden; sys.modules['{blocked}'] = None\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", hide + script.format(h5="mindlin.h5", nml=PROJECT / "examples/mindlin.nml")],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 1
    assert f"the Python package {blocked} is not installed: " in done.stderr.splitlines()[-1], done.stderr
    assert "-m pip install " in done.stderr.splitlines()[-1]


@pytest.mark.skipif(not shutil.which("pkg-config"), reason="there is no pkg-config on this machine (scripts/test.sh installs it)")
def test_the_lines_that_build_programs_are_right_as_printed(tmp_path: Path) -> None:
    """`cmake --install`, then the compilers with pkg-config; each program is run without LD_LIBRARY_PATH."""
    page = (PROJECT / "docs/install.md").read_text()
    (install,) = re.findall(r"^    (cmake --install .*)$", page, re.MULTILINE)
    (export,) = re.findall(r"^    (export PKG_CONFIG_PATH=.*)$", page, re.MULTILINE)
    lines = re.findall(r"^    ((?:cc|gfortran) .*)$", page, re.MULTILINE)
    assert len(lines) == 3
    (tmp_path / "examples").symlink_to(PROJECT / "examples")
    (tmp_path / "build").mkdir()
    (tmp_path / "build/release").symlink_to(BUILD)
    surroundings = {**os.environ, "HOME": str(tmp_path)}
    surroundings.pop("LD_LIBRARY_PATH", None)
    for line in (install, *(f"{export}\n{line.split('    #')[0]}\n./cylinder" for line in lines)):
        done = subprocess.run(["sh", "-ec", line], cwd=tmp_path, env=surroundings, capture_output=True, text=True)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
        assert line == install or "nodes in contact 86, stuck 67" in done.stdout
