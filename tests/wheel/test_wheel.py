"""The wheel as a user has it: in an environment of its own, without compilers, MFV_LIBRARY, PYTHONPATH (run.cmake)."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

import mfv
from mfv import _library

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PROGRAMS = ("mfv_run", "mfv_conventional", "mfv_stress")
#: Libraries of every Linux on which a wheel may be installed (the policies of manylinux).
BASE = re.compile(r"(linux-vdso|ld-linux\S*|lib(c|m|mvec|dl|pthread|rt|resolv|util|gcc_s|stdc\+\+|z))\.so")
SITE = Path(mfv.__file__).resolve().parents[1]


def binaries():
    """The library and the programs of the package."""
    return [Path(_library.find_library()), *((SITE / "mfv" / "bin" / name) for name in PROGRAMS)]


def loaded(name):
    """Paths of the shared libraries of this process whose file names begin with `name`."""
    maps = Path("/proc/self/maps").read_text()
    return {Path(path) for path in re.findall(r"(/\S+)$", maps, flags=re.MULTILINE) if Path(path).name.startswith(name)}


def test_package_is_that_of_the_environment():
    assert SITE.is_relative_to(sys.prefix)
    assert binaries()[0].parent == SITE / "mfv" / "lib"
    assert shutil.which("gfortran") is None and shutil.which("cc") is None


@pytest.mark.parametrize("binary", binaries(), ids=lambda path: path.name)
def test_everything_is_of_the_wheel_or_of_the_base_system(binary):
    needed = subprocess.run(["/usr/bin/ldd", binary], capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(needed) > 5
    strangers = [line for line in needed if not BASE.match(Path(line.split()[0]).name) and f"=> {SITE}/" not in line]
    assert strangers == []


def test_library_and_h5py_share_a_process(tmp_path):
    result = mfv.run(EXAMPLES / "mindlin.nml", output=tmp_path / "mindlin.h5")
    with h5py.File(tmp_path / "mindlin.h5") as file:
        assert np.array_equal(file["state/pressure"][()], result.state.pressure)
    with h5py.File(tmp_path / "own.h5", "w") as file:
        file["x"] = np.arange(3.0)
    again = mfv.run(EXAMPLES / "mindlin.nml", output=tmp_path / "again.h5")
    assert np.array_equal(mfv.read(tmp_path / "again.h5").state.shear, again.state.shear)
    folders = {path.parent for path in loaded("libhdf5")}
    assert SITE / "mfv_contact.libs" in folders and len(folders) == 2


@pytest.mark.parametrize("program", PROGRAMS)
def test_programs_are_commands(program):
    run = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    assert run.stdout.split()[:2] == [program, mfv.__version__]


def test_a_case_from_the_command_line(tmp_path):
    command = ["mfv_run", EXAMPLES / "mindlin.nml"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "complete" in run.stdout
    subprocess.run(["mfv_stress", "mindlin.h5"], cwd=tmp_path, capture_output=True, check=True)
    assert mfv.read(tmp_path / "mindlin.h5").certificate.largest < 1e-10
    assert subprocess.run(["mfv_run", "no/such.nml"], cwd=tmp_path, capture_output=True).returncode == 2


def test_files_of_the_package_are_there(tmp_path):
    subprocess.run([sys.executable, "-m", "mfv", "new"], cwd=tmp_path, capture_output=True, check=True)
    subprocess.run(["mfv_run", "cylinder.nml"], cwd=tmp_path, capture_output=True, check=True)
    subprocess.run([sys.executable, "-m", "mfv", "report", "cylinder.h5"], cwd=tmp_path, capture_output=True, check=True)
    assert "<html" in (tmp_path / "cylinder.html").read_text()[:1000]
    assert "usage: mfv COMMAND" in subprocess.run(["mfv"], capture_output=True, text=True, check=True).stdout


def test_licences_of_bundled_libraries():
    (info,) = SITE.glob("mfv_contact-*.dist-info")
    metadata = (info / "METADATA").read_text()
    assert "License-Expression: BSD-3-Clause AND GPL-3.0-or-later\n" in metadata
    texts = {path.name for path in (info / "licenses").iterdir()}
    assert {"LICENSE", "GPL-3.txt"} <= texts
    for library in "gsl", "fftw3", "openblas", "hdf5", "gfortran":
        assert any(library in name for name in texts), library
    assert set(re.findall(r"(?m)^License-File: (.+)$", metadata)) == texts
