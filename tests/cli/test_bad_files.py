"""Texts and files that are broken as such, and paths that lead to no file at all: in place of a case, a profile, a matrix,
coefficients, points, a result; and wrong arguments of the programs. A message with file and line and exit code 2; never a hang."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
STRESS, CONVENTIONAL = (RUN.with_name(name) for name in ("mfv_stress", "mfv_conventional"))
INPUT_ERROR = 2

ELASTIC = b"&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
DISK = b"&body shape='disk', radius=0.25, rigid=.true. /\n"
MESH = b"&mesh nodes=11, half_width=0.02 /\n"
BODIES = ELASTIC + DISK + MESH
PRESS = b"&step normal_force=1e-3 /\n"
CASE = BODIES + PRESS
LONG = 100_000


def run(program: Path, *arguments: object, cwd: Path, **more: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [program, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
        errors="replace",
        stdin=subprocess.DEVNULL,
        **more,
    )  # type: ignore[call-overload]


def refused(done: subprocess.CompletedProcess[str], *parts: str) -> None:
    assert done.returncode == INPUT_ERROR and done.stdout == "", done
    for part in parts:
        assert part in done.stderr, (part, done.stderr)
    assert len(done.stderr.splitlines()) == 1 and len(done.stderr) < 1000, done.stderr


GOOD = {
    "line feeds": CASE,
    "carriage returns too": CASE.replace(b"\n", b"\r\n"),
    "tabs": CASE.replace(b" ", b"\t"),
    "byte-order mark": b"\xef\xbb\xbf" + CASE,
    "no line feed at the end": CASE.rstrip(b"\n"),
    "in one line": CASE.replace(b"\n", b" "),
    "UTF-8 in texts and comments": "&scene title='Größe µ 接触 🙂', length_unit='µm' / ! naïve ½\n".encode() + CASE,
    "comment right after a value": CASE.replace(b"radius=0.25,", b"radius=0.25! comment & / 'x\n ,"),
    "comment without an end": CASE + b"! the end",
    "no blanks": CASE.replace(b", ", b","),
    "blanks in place of commas": CASE.replace(b", ", b" "),
    "upper case": CASE.replace(b"&body", b"&BODY").replace(b"radius", b"RADIUS"),
    "repeats": BODIES.replace(b"nodes=11", b"nodes=1*11") + b"&friction law='coulomb', mu=5*0.3, 0.4 5*0.5 /\n" + PRESS,
    "a long line of blanks": CASE + b" " * LONG + PRESS,
    "a long comment": b"!" + b"x" * LONG + b"\n" + CASE,
    "a long title": b"&scene title='" + b"x" * LONG + b"' /\n" + CASE,
    "a key in many lines": CASE.replace(b"radius=0.25", b"radius" + b"\n" * 1000 + b"=" + b"\n" * 1000 + b"0.25"),
    "many steps": BODIES + PRESS * 2000,
}


@pytest.mark.parametrize("name", GOOD)
def test_good_texts(tmp_path: Path, name: str) -> None:
    (tmp_path / "case.nml").write_bytes(GOOD[name])
    done = run(RUN, "--check", "case.nml", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == "", done


BROKEN = {
    "empty": (b"", "case.nml: &body: exactly two are needed"),
    "blanks": (b" \n\t\r\n  ", "case.nml: &body: exactly two are needed"),
    "a comment": (b"! nothing", "case.nml: &body: exactly two are needed"),
    "no step": (BODIES, "case.nml: &step: at least one step is needed"),
    "one body": (ELASTIC + PRESS, "exactly two are needed, first the lower body, then the upper one; found 1"),
    "three bodies": (CASE + DISK, "exactly two are needed, first the lower body, then the upper one; found 3"),
    "a group twice": (CASE + MESH, "case.nml:5: &mesh: may be given only once; it is already in line 3"),
    "an unknown group": (CASE + b"&sovler /", "case.nml:5: &sovler: unknown group; did you mean &solver?"),
    "a group of a sweep": (CASE + b"&vary key='mesh%nodes' /", "case.nml:5: &vary: unknown group"),
    "a key of another group": (CASE + b"&scene mu=0.3 /", "case.nml:5: &scene mu=0.3: unknown key; it is one of &friction"),
    "ampersand alone": (CASE + b"&", "case.nml:5: a group name must follow &"),
    "two ampersands": (CASE + b"&&scene /", "case.nml:5: a group name must follow &"),
    "no slash": (CASE.replace(b".true. /", b".true."), "case.nml:3: &body (line 2) has no / at its end"),
    "no slash at the end": (CASE.rstrip(b" /\n"), "case.nml:4: &step (line 4) has no / at its end"),
    "the old end": (CASE + b"&scene title='x' &end", "case.nml:5: &scene (line 5) has no / at its end"),
    "a group in a group": (CASE + b"&scene &mesh / /", "case.nml:5: &scene (line 5) has no / at its end"),
    "two slashes": (CASE + b"&scene / /", "case.nml:5: '/' is outside a group"),
    "words": (b"What is this?\n" + CASE, "case.nml:1: 'What is this?' is outside a group; a group begins with &name"),
    "no quote": (CASE + b"&scene title='x /\n&output /", "case.nml:5: &scene title: the text has no closing '"),
    "no double quote": (CASE + b'&scene title="x /', 'case.nml:5: &scene title: the text has no closing "'),
    "a text of two lines": (CASE + b"&scene title='x\ny' /", "case.nml:5: &scene title: the text has no closing '"),
    "commas": (CASE + b"&scene title='x',, plane='stress' /", "case.nml:5: &scene title: a value is missing next to a comma"),
    "commas at the end": (CASE + b"&scene title='x',, /", "case.nml:5: &scene title: a value is missing next to a comma"),
    "no key": (CASE + b"&scene ='x' /", "case.nml:5: &scene: expected key=value, not '='x' /'"),
    "Latin-1": (CASE + b"&scene title='Gr\xf6\xdfe' /", "case.nml:5: byte 246 is not UTF-8; save the file as UTF-8"),
    "Latin-1 in a comment": (CASE + b"! gro\xdf", "case.nml:5: byte 223 is not UTF-8"),
    "UTF-16": ("\ufeff".encode("utf-16-le") + CASE.decode().encode("utf-16-le"), "case.nml:1: byte 255 is not UTF-8"),
    "a character cut short": (CASE + b"! \xe2\x82", "case.nml:5: byte 226 is not UTF-8"),
    "an overlong character": (CASE + b"! \xc0\xaf", "case.nml:5: byte 192 is not UTF-8"),
    "half a pair": (CASE + b"! \xed\xa0\x80", "case.nml:5: byte 237 is not UTF-8"),
    "beyond Unicode": (CASE + b"! \xf4\x90\x80\x80", "case.nml:5: byte 244 is not UTF-8"),
    "a null": (CASE + b"&scene title='a\0b' /", "case.nml:5: control character 0: not a text file"),
    "an escape": (CASE + b"\n\x1b[31m", "case.nml:6: control character 27: not a text file"),
    "old Macintosh": (CASE.replace(b"\n", b"\r"), "case.nml:1: a carriage return without a line feed"),
    "binary": (bytes(range(256)) * 10, "case.nml:1: control character 0: not a text file"),
    "HDF5": (b"\x89HDF\r\n\x1a\n", "case.nml:1: an HDF5 file, such as a result; a text is needed"),
    "a long key": (CASE + b"&scene " + b"x" * LONG + b"=1 /", "x...=1: unknown key"),
    "a long group": (CASE + b"&" + b"x" * LONG + b" /", "x...: unknown group; groups are scene body"),
    "a long value": (CASE + b"&scene plane='" + b"\xc3\xa4" * LONG + b"' /", "...': must be 'strain' or 'stress'"),
    "a long number": (CASE.replace(b"0.25", b"9" * LONG), "...: must be a number above 0 (length)"),
    "a long list": (
        CASE + b"&friction law='coulomb', mu=100000*0.5 /",
        "mu=0.5, 0.5, 0.5, 0.5, 0.5, ... (100000 values): must have one value, or one per node (11), not 100000",
    ),
    "too long a list": (
        CASE + b"&friction law='coulomb', mu=100*0.5, 9999999*0.5 /",
        "the number before * must be a whole number from 1 to 9999900",
    ),
    "a million groups of one kind": (b"&scene /\n" * 1_000_000, "case.nml:2: &scene: may be given only once"),
    "a long line of nothing": (b"x" * 10_000_000, "case.nml:1: 'xxxxx"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_texts(tmp_path: Path, name: str) -> None:
    text, message = BROKEN[name]
    (tmp_path / "case.nml").write_bytes(text)
    refused(run(RUN, "--check", "case.nml", cwd=tmp_path), "case.nml:", message)


def test_repeats_are_what_they_stand_for(tmp_path: Path) -> None:
    tractions = []
    for name, coefficients in (("short", "5*0.3, 6*0.5"), ("long", "0.3, 0.3, 0.3, 0.3, 0.3, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5")):
        friction = f"&friction law='coulomb', mu={coefficients} /\n".encode()
        (tmp_path / f"{name}.nml").write_bytes(BODIES + friction + PRESS + b"&step tangential_force=1e-4 /\n")
        assert run(RUN, f"{name}.nml", cwd=tmp_path).returncode == 0
        with h5py.File(tmp_path / f"{name}.h5") as result:
            tractions.append(result["state/shear"][:].tobytes())
    assert tractions[0] == tractions[1]


#: What a path may lead to in place of a file, with what is said.
NO_FILES = {
    ".": "it is a directory",
    "/dev/zero": "it is a pipe or a device; save its content to a regular file",
    "/dev/null": "it is a pipe or a device",
    "/dev/stdin": "it is a pipe or a device",
    "pipe": "it is a pipe or a device",
    "": "the name of a file is empty",
    "nowhere": "nowhere",
    "file.txt/nowhere": "file.txt/nowhere",
    "loop": "loop",
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "file.txt").write_text("0 0\n")
    (tmp_path / "base.nml").write_bytes(CASE)
    return tmp_path


@pytest.mark.parametrize("path", NO_FILES)
def test_paths_that_lead_to_no_file(folder: Path, path: str) -> None:
    says = NO_FILES[path]
    refused(run(RUN, "--check", path, cwd=folder), says)
    refused(run(CONVENTIONAL, path, cwd=folder), says)
    key_says = says if path else "must not be empty"
    upper = f"&body shape='profile', file='{path}', rigid=.true. /\n".encode()
    (folder / "profile.nml").write_bytes(ELASTIC + upper + MESH + PRESS)
    refused(run(RUN, "--check", "profile.nml", cwd=folder), f"profile.nml:2: &body {'2 ' if path else ''}file='{path}': ", key_says)
    (folder / "matrix.nml").write_bytes(f"&body shape='matrix', file='{path}' /\n".encode() + DISK + PRESS)
    refused(run(RUN, "--check", "matrix.nml", cwd=folder), f"matrix.nml:1: &body {'1 ' if path else ''}file='{path}': ", key_says)
    (folder / "mu.nml").write_bytes(BODIES + f"&friction law='coulomb', mu_file='{path}' /\n".encode() + PRESS)
    refused(run(RUN, "--check", "mu.nml", cwd=folder), f"mu.nml:4: &friction mu_file='{path}': ", key_says)
    if path:
        refused(run(STRESS, path, cwd=folder), says)
    points = run(STRESS, "result.h5", "--at", path, cwd=folder)
    assert points.returncode == INPUT_ERROR and says in points.stderr.splitlines()[0]
    shown = subprocess.run(
        [sys.executable, "-m", "mfv", "info", path or "''"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"PYTHONPATH": str(ROOT / "python")},
    )
    assert shown.returncode != 0 and "Traceback" not in shown.stderr and shown.stderr.startswith("mfv: "), shown


def test_files_without_permission() -> None:
    folder = Path(tempfile.mkdtemp())
    try:
        folder.chmod(0o755)
        (folder / "case.nml").write_bytes(CASE)
        (folder / "case.nml").chmod(0)
        nobody = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
        try:
            done = run(RUN, "--check", "case.nml", cwd=folder, **nobody)
        except PermissionError:
            pytest.skip("another user may not run the program where it is")
        if done.returncode == 127:
            pytest.skip("another user may not load the library where it is")
        refused(done, "case.nml: cannot be read: ", "Permission denied")
    finally:
        shutil.rmtree(folder)


def test_a_file_of_gigabytes(tmp_path: Path) -> None:
    with open(tmp_path / "case.nml", "wb") as file:
        file.truncate(5_000_000_000)
    refused(run(RUN, "--check", "case.nml", cwd=tmp_path), "case.nml: too long; a text file may have at most 100000000 bytes")


PROFILES = {
    "empty": ("", "profile.txt: needs at least 3 points; it has 0"),
    "comments only": ("# x height\n! nothing\n\n", "profile.txt: needs at least 3 points; it has 0"),
    "two points": ("0 0\n1 1\n", "profile.txt: needs at least 3 points; it has 2"),
    "not increasing": ("0 0\n1 1\n1 2\n", "profile.txt:3: x must increase from line to line"),
    "one number": ("0 0\n1\n2 2\n", "profile.txt:2: must be two numbers, x and height, not '1'"),
    "three numbers": ("0 0\n1 1 1\n2 2\n", "profile.txt:2: must be two numbers, x and height, not '1 1 1'"),
    "a gap between commas": ("0 0\n1,,1\n2 2\n", "profile.txt:2: must be two numbers, x and height, not '1,,1'"),
    "a comma at the end": ("0 0\n1,\n2 2\n", "profile.txt: needs at least 3 points; it has 2 with values"),
    "a word": ("0 0\n1 one\n2 2\n", "profile.txt:2:3: must be two numbers, x and height, not '1 one'"),
    "NaN": ("0 0\n1 NaN\n2 2\n", "profile.txt: needs at least 3 points; it has 2 with values"),
    "Inf": ("0 0\n1 Inf\n2 2\n", "profile.txt:2:3: must be two numbers"),
    "huge": ("0 0\n1 1e400\n2 2\n", "profile.txt:2:3: must be two numbers"),
    "beyond what is taken": (
        "0 0\n1 1e200\n2 2\n",
        "profile.txt:2: numbers other than 0 must have a magnitude from 1e-100 to 1e100",
    ),
    "Fortran's repeats": ("0 0\n2*1\n2 2\n", "profile.txt:2:1: must be two numbers"),
    "a null": ("0 0\n1 1\0\n2 2\n", "profile.txt:2:4: not a text file: control character 0; write one: mfv profile profile.txt -o"),
    "a long line": ("0 0\n1 " + "9" * LONG + "\n2 2\n", "profile.txt:2:3: must be two numbers, x and height, not '1 9999"),
    "binary": ("\x89HDF\r\n\x1a\n\0\0", "profile.txt:2:1: not a text file: control character 26"),
    "a terminal's commands": ("0 0\n1 \x1b[31m\n", "profile.txt:2:3: not a text file: control character 27"),
    "bytes that are no UTF-8": ("0 0\n1 \xb5\n", "profile.txt:2:3: must be two numbers, x and height, not '1 ?'"),
    "headings only": ("# trace\nX,Z\nmm,mm\n", "profile.txt:2:1: must be two numbers, x and height, not 'X,Z'"),
    "a heading among numbers": ("X;Z\n0;0\nX;Z\n", "profile.txt:3:1: must be two numbers, x and height, not 'X;Z'"),
    "NaN at the beginning": ("NaN 0\n1 1\n2 2\n", "profile.txt: needs at least 3 points; it has 2 with values"),
    "one point with decimal commas": ("0,5;1,5\n", "profile.txt: needs at least 3 points; it has 1"),
    "two semicolons": ("0;;0\n", "profile.txt:1: must be two numbers, x and height, not '0;;0'"),
    "three columns": ("1 0 0\n2 0.1 0\n4 0.2 0\n", "profile.txt:1: must be two numbers, x and height, not '1 0 0'"),
    "another count": ("9\n0 0\n1 1\n2 2\n", "profile.txt:1: the file has 3 rows, not 9; complete it, or correct the number"),
    "heights alone": ("0.5\n0.4\n0.3\n", "profile.txt: has one column, heights; give the distance between them as position_scale"),
    "a turn": ("2 0\n1 1\n1.5 2\n", "profile.txt:3: x must increase from line to line, or decrease; it is 1.5 after 1"),
    "a line after the numbers": ("0 0\n1 1\n2 2\nend of trace\n", "profile.txt:4:1: must be two numbers"),
}


@pytest.mark.parametrize("name", PROFILES)
def test_broken_profiles(tmp_path: Path, name: str) -> None:
    points, message = PROFILES[name]
    (tmp_path / "profile.txt").write_bytes(points.encode("latin-1"))
    (tmp_path / "case.nml").write_bytes(ELASTIC + b"&body shape='profile', file='profile.txt', rigid=.true. /\n" + MESH + PRESS)
    refused(run(RUN, "--check", "case.nml", cwd=tmp_path), "case.nml:2: &body 2 file='profile.txt': ", message)


def test_profiles_of_other_editors(tmp_path: Path) -> None:
    (tmp_path / "case.nml").write_bytes(ELASTIC + b"&body shape='profile', file='profile.txt', rigid=.true. /\n" + MESH + PRESS)
    for points in (
        b"-1 1\r\n0 0\r\n1 1\r\n",
        b"-1\t1\n\n0 , 0\n1,1",
        b"\xef\xbb\xbf-1 1\n0 0\n 1   1  \n",
        b"# \xfc\n-1 1\n0 0\n1D0 +1.\n",
        b"Trace 1\r\nX (\xb5m);Z (\xb5m)\r\n-1;1\r\n0 ; 0\r\n1;\t1\r\n",
    ):
        (tmp_path / "profile.txt").write_bytes(points)
        done = run(RUN, "--check", "case.nml", cwd=tmp_path)
        assert done.returncode == 0, (points, done)


N = 5
X = np.linspace(-1.0, 1.0, N)
GOOD_MATRIX = np.eye(2 * N) + 0.1
MATRICES = {
    "no x": ({"compliance": GOOD_MATRIX}, "dataset x is missing"),
    "x of no numbers": ({"x": np.array([b"a"] * N), "compliance": GOOD_MATRIX}, "x does not hold numbers"),
    "x of two dimensions": ({"x": X.reshape(1, N), "compliance": GOOD_MATRIX}, "x has 2 dimensions, not 1"),
    "x with NaN": ({"x": np.where(X > 0.9, np.nan, X), "compliance": GOOD_MATRIX}, "x is not finite at node 5"),
    "x not increasing": ({"x": -X, "compliance": GOOD_MATRIX}, "x is not increasing at node 2"),
    "no nodes": ({"x": X[:0], "compliance": GOOD_MATRIX}, "x has 0 nodes; allowed are 1 to 20000"),
    "no matrix": ({"x": X}, "give exactly one of compliance and stiffness"),
    "two matrices": ({"x": X, "compliance": GOOD_MATRIX, "stiffness": GOOD_MATRIX}, "exactly one of compliance and stiffness"),
    "another shape": (
        {"x": X, "compliance": np.eye(3)},
        "compliance has the shape 3 x 3; with 5 positions in x it must be 5 x 5, or 10 x 10",
    ),
    "a vector": ({"x": X, "compliance": X}, "compliance has 1 dimensions, not 2"),
    "NaN": ({"x": X, "compliance": GOOD_MATRIX * np.nan}, "compliance is not finite in row 1, column 1"),
    "Inf": ({"x": X, "compliance": GOOD_MATRIX + np.diag([np.inf] + [0] * (2 * N - 1))}, "compliance is not finite"),
    "not symmetric": ({"x": X, "compliance": GOOD_MATRIX + np.triu(GOOD_MATRIX)}, "compliance is not symmetric"),
    "not positive": ({"x": X, "compliance": -GOOD_MATRIX}, "compliance is not positive definite"),
    "zero": ({"x": X, "compliance": 0.0 * GOOD_MATRIX}, "compliance is not positive definite"),
    "singular": ({"x": X, "stiffness": np.ones((2 * N, 2 * N))}, "stiffness is not positive definite"),
    "short gap": ({"x": X, "gap": X[:3], "compliance": GOOD_MATRIX}, "gap has 3 values, x has 5"),
    "one node without width": ({"x": X[:1], "compliance": np.eye(2)}, "width is missing; it is required with a single node"),
    "width of nothing": ({"x": X, "width": 0.0 * X, "compliance": GOOD_MATRIX}, "width is not positive at node 1"),
}


@pytest.mark.parametrize("name", MATRICES)
def test_broken_matrices(tmp_path: Path, name: str) -> None:
    datasets, message = MATRICES[name]
    with h5py.File(tmp_path / "matrix.h5", "w") as file:
        for dataset, values in datasets.items():
            file[dataset] = values
    (tmp_path / "case.nml").write_bytes(b"&body shape='matrix', file='matrix.h5' /\n" + DISK + PRESS)
    refused(run(RUN, "--check", "case.nml", cwd=tmp_path), "case.nml:1: &body 1 file='matrix.h5': ", message)


ELASTIC_MATRIX = b"&body shape='matrix', file='matrix.h5' /\n"
PUNCH = b"&body shape='flat_punch', half_width=0.1, rigid=.true. /\n"


@pytest.mark.parametrize(
    "text, message",
    [
        (
            b"&body shape='matrix', file='matrix.h5', rigid=.true. /\n" + DISK + PRESS,
            "case.nml:2: &body 2 rigid=.true.: both bodies are rigid",
        ),
        (DISK + ELASTIC_MATRIX + PRESS, "case.nml:2: &body 2 shape='matrix': a matrix must be the first body, the lower one"),
        (ELASTIC_MATRIX + DISK + b"&mesh nodes=5 /\n" + PRESS, "case.nml:3: &mesh nodes=5: has no effect for a matrix"),
        (ELASTIC_MATRIX + DISK + b"&friction law='coulomb', mu=0.5 /\n" + PRESS, "friction needs the tangential ones too"),
        (ELASTIC_MATRIX + b"&body shape='profile', file='profile.txt', rigid=.true. /\n" + PRESS, "no node of this body is under"),
        (
            b"&body shape='profile', file='profile.txt', shear_modulus=1.0, poisson_ratio=0.3 /\n"
            + PUNCH
            + PRESS
            + b"&mesh half_width=0.01, nodes=5 /\n",
            "no node of this mesh is under the indenter",
        ),
        (PUNCH + PUNCH + PRESS, "case.nml:2: &body 2 rigid=.true.: both bodies are rigid"),
        (
            ELASTIC + DISK + b"&friction law='static_kinetic', mu_static=0.5, mu_kinetic=0.3, 0.4 /\n" + MESH + PRESS,
            "case.nml:3: &friction mu_kinetic=0.3, 0.4: must have one value, or one per node (11), not 2",
        ),
        (
            ELASTIC + DISK + b"&friction law='static_kinetic', mu_static=0.5, 0.6, 0.7, mu_kinetic=0.3, 0.4 /\n" + MESH + PRESS,
            "case.nml:3: &friction mu_kinetic=0.3, 0.4: must have one value, or as many as mu_static",
        ),
        (
            ELASTIC + DISK + b"&friction law='coulomb', mu_file='short.txt' /\n" + PRESS,
            "short.txt: needs at least 2 lines of numbers",
        ),
        (
            ELASTIC + DISK + b"&friction law='static_kinetic', mu_file='rising.txt' /\n" + PRESS,
            "rising.txt: mu_kinetic must not be above mu_static",
        ),
    ],
)
def test_what_does_not_go_together(tmp_path: Path, text: bytes, message: str) -> None:
    """Bodies, meshes and coefficients that are each right alone. The matrix has normal components only."""
    with h5py.File(tmp_path / "matrix.h5", "w") as file:
        file["x"] = X
        file["compliance"] = np.eye(N) + 0.1
    (tmp_path / "profile.txt").write_text("5 0\n6 0.1\n7 0.4\n")
    (tmp_path / "short.txt").write_text("0 0.5\n")
    (tmp_path / "rising.txt").write_text("0 0.5 0.4\n1 0.5 0.6\n")
    (tmp_path / "case.nml").write_bytes(text)
    refused(run(RUN, "--check", "case.nml", cwd=tmp_path), "case.nml:", message)


def test_matrices_have_no_other_meshes(tmp_path: Path) -> None:
    """Neither an estimate of the error nor advice on the mesh."""
    with h5py.File(tmp_path / "matrix.h5", "w") as file:
        file["x"] = X
        file["compliance"] = np.eye(N) + 0.1
    (tmp_path / "case.nml").write_bytes(ELASTIC_MATRIX + DISK + PRESS)
    refused(
        run(RUN, "--estimate", "case.nml", cwd=tmp_path), "case.nml: --estimate: a body with shape='matrix' has no coarser mesh"
    )
    refused(
        run(RUN, "--advise", "error=1e-2", "case.nml", cwd=tmp_path),
        "case.nml: no advice: a body with shape='matrix' has a fixed mesh",
    )


def test_results_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "case.nml").write_bytes(CASE)
    assert run(RUN, "case.nml", cwd=tmp_path).returncode == 0
    whole = (tmp_path / "case.h5").read_bytes()
    (tmp_path / "text.h5").write_bytes(CASE)
    (tmp_path / "empty.h5").write_bytes(b"")
    (tmp_path / "cut.h5").write_bytes(whole[: len(whole) // 2])
    for name in ("text.h5", "empty.h5", "cut.h5"):
        refused(run(STRESS, name, cwd=tmp_path), name)
        shown = subprocess.run(
            [sys.executable, "-m", "mfv", "info", name],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=300,
            env=os.environ | {"PYTHONPATH": str(ROOT / "python")},
        )
        assert shown.returncode != 0 and shown.stderr.startswith("mfv: ") and name in shown.stderr, shown


ARGUMENTS = [
    (RUN, ("", "case.nml"), "too many arguments: 'case.nml'"),
    (RUN, ("case.nml", "case.nml"), "too many arguments: 'case.nml'"),
    (RUN, (), "a case file is missing"),
    (RUN, ("--check",), "a case file is missing"),
    (RUN, ("case.nml", "--check", "--resume"), "--check only reads the case; remove the other options"),
    (RUN, ("--chekc", "case.nml"), "unknown option '--chekc'; did you mean --check?"),
    (RUN, ("-",), "unknown option '-'"),
    (RUN, ("--" + "x" * LONG,), "unknown option '--xxx"),
    (RUN, ("x" * 200, "x" * LONG), "too many arguments: 'xxx"),
    *(
        (RUN, ("--advise", f"error={wrong}", "case.nml"), f"--advise error={wrong}: must be a number above 0 and below 1")
        for wrong in ("", "0", "1", "-1e-2", "NaN", "Inf", "1e400", "1e-400", "x", "1e", "1.5+3", "1e-2,")
    ),
    (RUN, ("--advise", "case.nml"), "--advise needs the wanted error"),
    (RUN, ("--advise", "error=1e-2", "error=1e-3", "case.nml"), "--advise error=1e-3: error is given twice"),
    (RUN, ("--advise", "error=1e-2", "of=", "case.nml"), "must be one or more of"),
    (RUN, ("--advise", "error=1e-2", "of=x", "case.nml"), "'x' is not one of"),
    (RUN, ("--advise", "error=1e-2", "--check", "case.nml"), "--advise does not take the option '--check'"),
    (CONVENTIONAL, (), "a case file is missing"),
    (CONVENTIONAL, ("case.nml", "case.nml"), "too many arguments: 'case.nml'"),
    (CONVENTIONAL, ("--check",), "unknown option '--check'"),
    (STRESS, ("",), "a result file is missing"),
    (STRESS, ("result.h5", "result.h5"), "too many arguments: 'result.h5'"),
    *(
        (STRESS, ("result.h5", "--step", wrong), f"--step needs a whole number from 1 to 100000, not '{wrong}'")
        for wrong in ("", "0", "-1", "1.5", "NaN", "100001", "99999999999999999999", "1e400")
    ),
    *(
        (STRESS, ("result.h5", option, wrong), f"{option} needs a number above 0 and at most 100000, not '{wrong}'")
        for option in ("--width", "--depth")
        for wrong in ("", "0", "-1", "NaN", "Inf", "1e400", "1e-400", "1e6", "x")
    ),
    (STRESS, ("result.h5", "--points", "2"), "--points needs a whole number from 2 to 100000, not ''"),
    (STRESS, ("result.h5", "--points", "100000", "100000"), "--points asks for more than 1e7 points"),
    (STRESS, ("result.h5", "--at", "nothing.txt"), "nothing.txt has no points"),
    (STRESS, ("result.h5", "--body"), "--body must be lower or upper, not ''"),
]


@pytest.mark.parametrize(
    ("program", "arguments", "message"),
    ARGUMENTS,
    ids=[f"{program.name} {' '.join(arguments)[:40]}" for program, arguments, _ in ARGUMENTS],
)
def test_wrong_arguments(tmp_path: Path, program: Path, arguments: tuple[str, ...], message: str) -> None:
    (tmp_path / "case.nml").write_bytes(CASE)
    (tmp_path / "nothing.txt").write_text("# x y\n")
    done = run(program, *arguments, cwd=tmp_path)
    first, *rest = done.stderr.splitlines()
    assert done.returncode == INPUT_ERROR and done.stdout == "", done
    assert first.startswith(f"{program.name}: ") and message in first and len(first) < 500, done.stderr
    assert rest[0].startswith("usage: ") and rest[-1] == f"Try '{program.name} --help' for more information."
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.nml", "nothing.txt"]
