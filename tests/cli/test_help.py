"""What the programs say about themselves: --help with cases that work, manual pages made from it, completion."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mfv import commands

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run")).parent
PROGRAMS = ("mfv_run", "mfv_stress", "mfv_conventional")
COMMANDS = [module.NAME for module in commands.COMMANDS]
PAGES = sorted((ROOT / "docs/man").glob("*.[15]"))
BASH = ROOT / "drivers/completion/mfv.bash"
COMPLETE, INPUT = 0, 2


def run(program, *arguments, cwd=ROOT):
    return subprocess.run(
        [BIN / program, *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
    )


def help_of(program):
    return run(program, "--help").stdout


def options_of(program):
    return re.findall(r"^  (?:-\w, )?(--[a-z-]+)", help_of(program), re.MULTILINE)


@pytest.mark.parametrize("program", PROGRAMS)
def test_help_has_what_a_newcomer_needs(program):
    for option in ("--help", "-h"):
        shown = run(program, option)
        assert shown.returncode == COMPLETE and shown.stderr == ""
        assert shown.stdout.startswith(f"usage: {program} ")
        for heading in ("Options", "Exit codes", "Examples", "See also"):
            assert f"\n{heading}:\n" in shown.stdout
    assert max(map(len, shown.stdout.splitlines())) <= 100
    assert {"--help", "--version"} <= set(options_of(program))
    used = set(re.findall(r"--[a-z]+", shown.stdout.split("\n\n")[0]))
    assert used <= set(options_of(program)), "an option of the usage that is not explained"


@pytest.mark.parametrize("program", PROGRAMS)
def test_options_that_help_explains_are_known(program):
    for option in options_of(program):
        refused = run(program, option, "--no-such-option").stderr
        assert f"unknown option '{option}'" not in refused, refused


@pytest.mark.parametrize(
    "program, option, nearest",
    [
        ("mfv_run", "--chekc", "--check"),
        ("mfv_stress", "--bodi", "--body"),
        ("mfv_conventional", "--verson", "--version"),
        ("mfv_run", "--frobnicate", None),
    ],
)
def test_unknown_options_propose_the_nearest(program, option, nearest):
    refused = run(program, option)
    assert refused.returncode == INPUT and refused.stdout == ""
    first, *rest = refused.stderr.splitlines()
    assert first == f"{program}: unknown option '{option}'" + (f"; did you mean {nearest}?" if nearest else "")
    assert rest[0].startswith("usage: ") and rest[-1] == f"Try '{program} --help' for more information."


@pytest.mark.parametrize("arguments", [("case.nml", "--check"), ("--check", "case.nml"), ("case.nml", "--estimate")])
def test_options_may_follow_the_case(arguments, tmp_path):
    (tmp_path / "case.nml").write_text("\n".join(re.findall(r"^  &.*", help_of("mfv_run"), re.MULTILINE)))
    done = run("mfv_run", *arguments, cwd=tmp_path)
    assert done.returncode == COMPLETE and done.stderr == ""
    assert ("error estimate" in done.stdout) == ("--estimate" in arguments)
    assert (tmp_path / "case.h5").exists() == ("--estimate" in arguments)


@pytest.mark.parametrize("program", PROGRAMS)
def test_help_may_follow_other_arguments(program):
    assert run(program, "case", "--help").stdout == help_of(program)


@pytest.mark.parametrize("program", PROGRAMS)
def test_programs_without_arguments_print_their_usage(program):
    done = run(program)
    first, *rest = done.stderr.splitlines()
    assert done.returncode == INPUT and done.stdout == "" and first.endswith(" file is missing")
    assert rest == [*help_of(program).split("\n\n")[0].splitlines(), f"Try '{program} --help' for more information."]


def test_the_case_in_the_help_is_one(tmp_path):
    (tmp_path / "case.nml").write_text("\n".join(re.findall(r"^  &.*", help_of("mfv_run"), re.MULTILINE)))
    done = run("mfv_run", "case.nml", cwd=tmp_path)
    assert done.returncode == COMPLETE and "complete: step 2 was reached" in done.stdout and "stick ratio" in done.stdout


def test_manual_pages_are_those_of_the_programs(tmp_path):
    subprocess.run([sys.executable, ROOT / "scripts/manual.py", BIN, tmp_path], check=True)
    assert {page.name for page in PAGES} == {page.name for page in tmp_path.iterdir()}
    for page in PAGES:
        assert page.read_text() == (tmp_path / page.name).read_text(), (
            "build/venv/bin/python scripts/manual.py build/release/bin docs/man"
        )


def test_tables_of_keys_are_those_of_the_catalogue():
    done = subprocess.run([sys.executable, ROOT / "scripts/keys.py", "--check", BIN], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_manual_pages_have_every_key_and_option(page):
    text = page.read_text().replace(r"\-", "-")
    if page.suffix == ".1":
        expected = COMMANDS if page.stem == "mfv" else options_of(page.stem)
    else:
        keys = run("mfv_run", "--keys").stdout
        expected = re.findall(r"^\| `(\w+)`", keys, re.MULTILINE)
        assert len(expected) > 10
    for name in expected:
        assert re.search(rf"^\.TP\n\\fB(-\w, )?{name}\b", text, re.MULTILINE), name


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
@pytest.mark.parametrize(
    "checker",
    [("mandoc", "-T", "lint", "-W", "warning"), ("groff", "-man", "-ww", "-z", "-T", "utf8")],
    ids=lambda checker: checker[0],
)
def test_manual_pages_are_free_of_warnings(checker, page):
    if shutil.which(checker[0]) is None:
        pytest.skip(f"{checker[0]} is not installed")
    checked = subprocess.run([*checker, page], capture_output=True, text=True)
    assert checked.returncode == 0 and checked.stdout + checked.stderr == ""


def completions(line, cwd):
    """What bash proposes at the end of a line, as a user's shell calls the function."""
    script = f"""source '{BASH}'
        PATH='{BIN}':$PATH
        COMP_LINE=$1 COMP_POINT=${{#1}} COMP_WORDS=(${{1//=/ = }})
        [[ $1 != *' ' ]] || COMP_WORDS+=('')
        COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
        completer=$(complete -p "${{COMP_WORDS[0]}}")
        completer=${{completer#* -F }}
        "${{completer%% *}}" "${{COMP_WORDS[0]}}" "${{COMP_WORDS[COMP_CWORD]}}" "${{COMP_WORDS[COMP_CWORD - 1]}}"
        printf '%s\\n' "${{COMPREPLY[@]}}" """
    shown = subprocess.run(["bash", "-c", script, "bash", line], cwd=cwd, capture_output=True, text=True, check=True)
    assert shown.stderr == ""
    return set(shown.stdout.split("\n")) - {""}


@pytest.fixture
def folder(tmp_path):
    for name in ("case.nml", "second.nml", "with blank.nml", "case.h5", "other.h5", "points.txt"):
        (tmp_path / name).touch()
    (tmp_path / "cases").mkdir()
    return tmp_path


@pytest.mark.parametrize("program", PROGRAMS)
def test_every_option_is_completed(program, folder):
    assert completions(f"{program} --", folder) == set(options_of(program))


@pytest.mark.parametrize(
    "line, expected",
    [
        ("mfv_run ", {"case.nml", "second.nml", "with blank.nml", "case.h5", "other.h5", "points.txt", "cases"}),
        ("mfv_run --check cas", {"case.nml", "case.h5", "cases"}),
        ("mfv_conventional s", {"second.nml"}),
        ("mfv_stress case.h5 --bo", {"--body"}),
        ("mfv_stress case.h5 --at p", {"points.txt"}),
    ],
)
def test_arguments_are_completed(line, expected, folder):
    assert completions(line, folder) == expected


@pytest.mark.parametrize("shell, file", [("bash", "mfv.bash"), ("zsh", "_mfv"), ("fish", "mfv.fish")])
def test_shells_can_read_the_completion(shell, file):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    checked = subprocess.run([shell, "-n", ROOT / "drivers/completion" / file], capture_output=True, text=True)
    assert checked.returncode == 0 and checked.stderr == ""


def test_fish_completes_every_option(folder):
    if shutil.which("fish") is None:
        pytest.skip("fish is not installed")
    path = ROOT / "drivers/completion/mfv.fish"
    for program in PROGRAMS:
        script = f"set PATH '{BIN}' $PATH; source '{path}'; complete -C '{program} --'"
        shown = subprocess.run(["fish", "-c", script], cwd=folder, capture_output=True, text=True, check=True).stdout
        assert {line.split("\t")[0] for line in shown.splitlines()} == set(options_of(program))


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["mfv_run", "case.nml", "--chekc"], "mfv_run: unknown option '--chekc'; did you mean --check?\n"),
        (["mfv_run", "--chekc", "case.nml"], "mfv_run: unknown option '--chekc'; did you mean --check?\n"),
        (["mfv_conventional", "--estimate", "case.nml"], "mfv_conventional: unknown option '--estimate'\n"),
    ],
)
def test_unknown_options_before_and_after_the_case(arguments, message, tmp_path):
    answer = run(*arguments, cwd=tmp_path)
    assert answer.returncode == 2 and answer.stderr.startswith(message)
