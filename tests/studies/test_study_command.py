"""`mfv study` as a user runs it: tables, messages with their lines, and restarts after any end."""

import contextlib
import csv
import random
import re
import resource
import runpy
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from small import (
    BASE,
    CASES,
    COMPLETE,
    INPUT,
    INTERRUPTED,
    MFV_RUN,
    PAD,
    PAD_STUDY,
    ROOT,
    STUDY,
    command,
    environment,
    long_study,
    run,
    write,
)

import mfv
from mfv.commands import main
from mfv.studies.namelist import KEYS, check_study, read_study
from mfv.studies.store import Store


def start(*arguments, cwd):
    return subprocess.Popen(
        command(*arguments),
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment(),
        start_new_session=True,
    )


def read(path):
    with xarray.open_dataset(path) as table:
        return table.load()


def bytes_kept(folder):
    """Size of the saved cases: SQLite's log grows with every case."""
    return sum(path.stat().st_size for path in folder.glob("study.sqlite*") if not path.name.endswith("-shm"))


def wait_for_growth(folder, size, process):
    """Wait until more than this is saved; false if the process ended first."""
    while process.poll() is None:
        try:
            if bytes_kept(folder) > size:
                return True
        except FileNotFoundError:
            pass
        time.sleep(0.002)
    return False


def cases_kept(folder):
    with contextlib.closing(sqlite3.connect(folder / "study.sqlite")) as connection:
        return connection.execute("SELECT count(*) FROM cases").fetchone()[0]


def test_the_table_is_that_of_the_library_function(study, tmp_path):
    _folder, table = study
    write(tmp_path)
    done = run("study.nml", "-o", "out.nc", cwd=tmp_path)
    assert done.returncode == COMPLETE and done.stderr == ""
    counted, warned = done.stdout.splitlines()[:2]
    assert counted == "out.nc: 18 cases: 15 complete, 3 gross sliding"
    assert warned.startswith("12 of 18 cases have warnings, 12 of them quantities that are not resolved")
    written = read(tmp_path / "out.nc")
    assert written.attrs["input"] == STUDY and written["base"] == "base.nml"
    for name in table.data_vars:
        if name != "message":
            np.testing.assert_array_equal(written[name], table[name], err_msg=name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["base.nml", "out.nc", "out.sqlite", "study.nml"]


def test_comma_separated_values(study, tmp_path):
    _, table = study
    write(tmp_path)
    assert run("study.nml", "-o", "out.csv", cwd=tmp_path).returncode == COMPLETE
    with open(tmp_path / "out.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    names = ["case", "base", "friction%mu", "Q [N/mm]", "scene%coupling", "outcome", "status", "message", "warnings", "unresolved"]
    assert list(rows[0])[:10] == names and "cycle_dissipation [N]" in rows[0] and "stick_ratio" in rows[0]
    assert [float(row["shift [mm]"]) for row in rows] == list(table["shift"].values.ravel())
    assert rows[0]["base"] == "base.nml" and {row["outcome"] for row in rows} == {"complete", "gross sliding"}


def test_cases_are_listed_and_printed(tmp_path):
    write(tmp_path)
    done = run("study.nml", "--list", cwd=tmp_path)
    assert done.returncode == COMPLETE and f"study.nml is valid: {CASES} cases, to be written to study.nc" in done.stdout
    assert "case 2: base='base.nml', friction%mu=0.3, Q=0.0001, scene%coupling='goodman'" in done.stdout
    done = run("study.nml", "--case", 5, cwd=tmp_path)
    (tmp_path / "case.nml").write_text(done.stdout)
    subprocess.run([MFV_RUN, "case.nml"], cwd=tmp_path, capture_output=True, check=True)
    with h5py.File(tmp_path / "case.h5") as result:
        shift = result["observables/shift"][()]
    assert shift == read_study(tmp_path / "study.nml").run()["shift"].values.ravel()[4]
    done = run("study.nml", "--case", 99, cwd=tmp_path)
    assert done.returncode == INPUT and "no case 99; the cases are numbered from 1 to 18" in done.stderr
    printed = run("--keys", cwd=tmp_path).stdout
    assert all(f"| `{name}` |" in printed for keys in KEYS.values() for name in keys)


def test_a_case_is_printed_though_others_cannot_be_used(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='friction%mu', values=0.3, 0 /\n")
    for number, mu in ((1, "0.3"), (2, "0")):
        done = run("study.nml", "--case", number, cwd=tmp_path)
        assert done.returncode == COMPLETE and f"mu={mu}" in done.stdout.replace(" ", ""), done.stdout


@pytest.mark.parametrize(
    "change, line, words",
    [
        (("friction%mu", "friction%my"), 2, "&vary 1 key='friction%my': 'friction%my': unknown key of &friction; did you mean mu?"),
        (("friction%mu", "frictoin%mu"), 2, "unknown group; did you mean friction?"),
        (("step(2)", "step(4)"), 3, "no &step 4 in base.nml, which has 3"),
        (("values=0.3, 0.7", "values=0.3, -0.7"), 2, "&friction mu=-0.7: must be a number at least 0"),
        (("'goodman', 'none'", "'gudman', 'none'"), 4, "&scene coupling='gudman': must be 'full', 'goodman' or 'none'"),
        (("base='base.nml'", "base='bass.nml'"), 1, "&sweep base='bass.nml': bass.nml cannot be read: No such file or directory"),
        (("base='base.nml'", "base=''"), 1, "&sweep base='': must not be empty"),
        (("base='base.nml', ", ""), 1, "&sweep: needs base"),
        (("&vary key='friction", "&very key='friction"), 2, "&very: unknown group; did you mean &vary?"),
        (("&vary key='friction", "&body key='friction"), 2, "&body: a case, not a study; solve it with 'mfv run'"),
        (("spacing='log'", "spacing='logg'"), 3, "&vary 2 spacing='logg': must be 'linear' or 'log'"),
        (("spacing='log'", "spaicng='log'"), 3, "&vary spaicng: unknown key; did you mean spacing?"),
        (("spacing='log'", "count=4"), 3, "count: given twice"),
        (("from=1e-4", "from=-1e-4"), 3, "needs from and to that are nonzero and of the same sign"),
        (("count=3, ", ""), 3, "needs values=..., or from, to and count; count is missing"),
        (("count=3", "count=0"), 3, "&vary 2 count=0: must be a whole number from 1 to 100000"),
        (("count=3", "count=2.5"), 3, "&vary 2 count=2.5: must be a whole number"),
        (("count=3", "values=1e-4"), 3, "values is also given; give either values, or from, to and count"),
        (
            ("'full', 'goodman', 'none'", "'goodman', 'none'"),
            1,
            "reference='full': needs a &vary with the single key='scene%coupling' and 'full'",
        ),
        (
            ("reference='full'", "reference='mesh%nodes=11'"),
            1,
            "needs a &vary with the single key='mesh%nodes' and '11' among its values",
        ),
        (("name='Q'", "name='outcome'"), 3, "&vary 2 name='outcome': outcome is a column of every study"),
        (("name='Q'", "name='friction%mu'"), 3, "friction%mu is the name of another axis"),
        (("name='Q'", "name=' '"), 3, "&vary 2 name=' ': must not be empty"),
        (("base='base.nml'", "base='base.nml', file=''"), 1, "&sweep file='': must not be empty"),
        (("name='Q'", "name=3"), 3, "&vary 2 name=3: must be a text between quotes"),
        (("factor=1, -1", "factor=1"), 3, "must have one value per key (2), not 1"),
        (("factor=1, -1", "factor='a', 'b'"), 3, "&vary 2 factor='a', 'b': must be a number"),
        (("reference='full'", "combine='paired'"), 1, "&vary 2 has 3 values, &vary 1 has 2"),
        (("reference='full' /", "reference='full' /\n&sweep base='base.nml' /"), 2, "&sweep: given twice"),
        (("key='friction%mu', ", ""), 2, "&vary 1: key missing"),
        (("values=0.3, 0.7", "values=0.3, 'a'"), 2, "friction%mu='a'"),
        (("values=0.3, 0.7 /", "values=0.3, 0.7"), 3, "&vary (line 2) has no / at its end"),
    ],
)
def test_bad_input_is_named(change, line, words, tmp_path, capsys, monkeypatch):
    write(tmp_path, STUDY.replace(*change))
    monkeypatch.chdir(tmp_path)
    assert main(["study", "study.nml"]) == INPUT
    printed, said = capsys.readouterr()
    assert re.match(rf"mfv: study\.nml:{line}: ", said) and words in said and printed == "", said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["base.nml", "study.nml"]


#: What is put into texts of studies, or in place of a word.
PIECES = ("'", '"', "/", "&", "=", ",", "%", "(", "!", "\n", "\x00", "\xe9", "1e400", "-1", "0", "nan", ".true.", "'full'", "3*0.5", "&vary", "&sweep",
          "key", "values", "from", "count", "'mesh%nodes'", "'dundurs_beta'", "name='a/b'", "99999999999", "combine='paired'", "5*", "1.5e300",
          "'step(2)%shift'", "'step(99999999999)%shift'", "'step()%shift'", "'body(1)%file'", "factor=1e300", "base='base.nml', 'base.nml'")  # fmt: skip


def damaged(text, chance):
    """A text with something put in, taken out, put in place of a word, or twice."""
    for _ in range(chance.randint(1, 4)):
        place = chance.randrange(len(text) + 1)
        word = chance.choice(list(re.finditer(r"'[^']*'|[\w.%-]+|$", text)))
        end = min(len(text), place + chance.randint(1, 20))
        text = chance.choice((
            text[:place] + chance.choice(PIECES) + text[place:],
            text[:place] + text[end:],
            text[: word.start()] + chance.choice(PIECES) + text[word.end() :],
            text[:end] + text[place:],
        ))  # fmt: skip
    return text


def test_damaged_texts_are_taken_or_refused_with_a_message(tmp_path, monkeypatch):
    write(tmp_path)
    monkeypatch.chdir(tmp_path)
    chance, refused = random.Random(2026), 0
    for _ in range(200):
        Path("study.nml").write_bytes(damaged(STUDY, chance).encode())
        try:
            study = read_study("study.nml")
            if len(study) < 200:
                check_study(study)
        except (mfv.errors.InputError, OSError) as error:
            assert "study.nml" in str(error)
            refused += 1
    assert 100 < refused < 200
    for path in ("/dev/null", str(tmp_path), "no.nml"):
        with pytest.raises((mfv.errors.InputError, OSError)):
            read_study(path)


def test_values_that_the_case_refuses_are_named(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='friction%mu',\n values=0.3, 0 /\n")
    done = run("study.nml", cwd=tmp_path)
    assert done.returncode == INPUT
    assert (
        "study.nml:3: &vary 1: case 2 (base='base.nml', friction%mu=0): base.nml:8: &step 2 tangential_force=2.8e-4: "
        in done.stderr
    )


def test_several_bases_pairs_and_whole_numbers(tmp_path):
    write(
        tmp_path,
        "&sweep base='base.nml', 'sub/other.nml', combine='paired' /\n&vary key='friction%mu', values=0.5, 0.7 /\n"
        "&vary key='step(1)%friction', values=.false., .true. /\n",
    )
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub/other.nml").write_text(BASE.format(nodes=15, cycles=1).replace("mu=0.7", "mu_file='mu.txt'"))
    (tmp_path / "sub/mu.txt").write_text("-1 0.7\n1 0.7\n")
    done = run("study.nml", "--list", cwd=tmp_path)
    assert done.returncode == INPUT and "base='sub/other.nml'" in done.stderr  # mu and mu_file
    (tmp_path / "sub/other.nml").write_text(BASE.format(nodes=15, cycles=1))
    assert run("study.nml", "-o", "out.csv", cwd=tmp_path).returncode == COMPLETE
    with open(tmp_path / "out.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["base"] for row in rows] == ["base.nml"] * 2 + ["sub/other.nml"] * 2
    assert [(row["friction%mu"], row["step(1)%friction"]) for row in rows] == [("0.5", "0"), ("0.7", "1")] * 2
    assert [row["nodes"] for row in rows] == ["21", "21", "15", "15"]
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='mesh%nodes', from=11, to=18, count=3 /\n")
    assert list(read_study(tmp_path / "study.nml").run()["mesh%nodes"]) == [11, 15, 18]
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='mesh%nodes', from=11, to=12, count=3 /\n")
    done = run("study.nml", cwd=tmp_path)
    assert (
        done.returncode == INPUT
        and "&vary 1 count=3: 11.5 and 12 both become 12, since mesh%nodes takes whole numbers" in done.stderr
    )


def test_a_mesh_as_reference(tmp_path):
    write(tmp_path, "&sweep base='base.nml', reference='mesh%nodes=81' /\n&vary key='mesh%nodes', name='n', values=21, 41, 81 /\n")
    errors = read_study(tmp_path / "study.nml").run()["pressure_error_loading"].values
    assert errors[0] > errors[1] > errors[2] == 0


def test_files_that_a_case_names_are_part_of_it(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='mesh%nodes', values=11, 21 /\n")
    text = (tmp_path / "base.nml").read_text()
    (tmp_path / "base.nml").write_text(text.replace("mu=0.7", "mu_file='mu.txt'"))
    counts = []
    for edge in (0.7, 0.7, 0.6):
        (tmp_path / "mu.txt").write_text(f"-1 {edge}\n1 0.7\n")
        assert run("study.nml", cwd=tmp_path).returncode == COMPLETE
        counts.append(cases_kept(tmp_path))
    assert counts == [2, 2, 4]


def test_only_new_cases_are_solved(tmp_path):
    write(tmp_path)
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == CASES
    write(tmp_path, STUDY.replace("0.3, 0.7", "0.3, 0.5, 0.7"))
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == CASES * 3 // 2
    (tmp_path / "base.nml").write_text("! another comment\n" + (tmp_path / "base.nml").read_text())
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == CASES * 3 // 2
    write(tmp_path, STUDY, nodes=23)
    assert run("study.nml", "-o", "study.csv", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == CASES * 5 // 2
    assert run("study.nml", "--again", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == CASES


def test_killed_at_random_moments(tmp_path):
    cases = long_study(tmp_path)
    undisturbed = read_study(tmp_path / "study.nml").run()
    chance = random.Random(17)
    before = 0
    for _ in range(5):
        process = start("study.nml", "--workers", 2, cwd=tmp_path)
        is_alive = wait_for_growth(tmp_path, bytes_kept(tmp_path) + chance.uniform(0.0, 12.0) * 4096, process)
        process.kill()
        process.communicate()
        if not is_alive:
            break
        kept = cases_kept(tmp_path)
        assert before <= kept <= cases
        before = kept
    assert not (tmp_path / "study.nc").exists() or before == cases
    done = run("study.nml", cwd=tmp_path)
    assert done.returncode == COMPLETE and f"{cases} complete" in done.stdout
    table = read(tmp_path / "study.nc")
    assert table.drop_attrs(deep=False).identical(undisturbed.drop_attrs(deep=False)) and table.attrs == undisturbed.attrs
    assert before > 0 and cases_kept(tmp_path) == cases


def test_processes_of_the_command_of_the_source_tree(tmp_path):
    """Processes import the file of the command, which must not run again there."""
    long_study(tmp_path)
    launcher = runpy.run_path(str(ROOT / "scripts" / "commands.py"))["LAUNCHER"]
    (tmp_path / "mfv").write_text(launcher.format(python=sys.executable))
    words = ["sh", "./mfv", "study", "study.nml", "--executor", "processes", "--workers", "2"]
    done = subprocess.run(words, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=100)
    assert done.returncode == COMPLETE, done.stderr


def test_a_process_that_has_ended_is_reported(tmp_path, monkeypatch, capsys):
    def ended(*_, **__):
        raise BrokenProcessPool("terminated abruptly")

    long_study(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mfv.studies.executors.solve_all", ended)
    assert main(["study", "study.nml", "--executor", "processes"]) == INPUT
    assert capsys.readouterr().err.startswith(
        "mfv: a process that solved cases has ended (out of memory, or killed?); solved cases"
    )


@pytest.mark.parametrize(("executor", "number"), [("threads", signal.SIGINT), ("processes", signal.SIGTERM)])
def test_interrupted(executor, number, tmp_path):
    cases = long_study(tmp_path)
    process = start("study.nml", "--executor", executor, "--workers", 2, cwd=tmp_path)
    assert wait_for_growth(tmp_path, 5 * 4096, process)
    process.send_signal(number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == INTERRUPTED
    assert said.splitlines() == [
        "mfv: solved cases are saved in study.sqlite; repeat the command to continue",
        "mfv: interrupted",
    ], said
    there = cases_kept(tmp_path)
    assert 0 < there < cases and not (tmp_path / "study.nc").exists()
    for options, words in (
        (["--so-far", "-o", "part.nc"], "part.sqlite"),
        (["--so-far", "--again"], "not allowed"),
        (["--again", "--executor", "none"], "unknown executor 'none'"),
    ):
        done = run("study.nml", *options, cwd=tmp_path)
        assert done.returncode == INPUT and words in done.stderr, done.stderr
    assert cases_kept(tmp_path) == there
    done = run("study.nml", "--so-far", cwd=tmp_path)
    assert done.stdout.splitlines()[0] == f"study.nc: {cases} cases: {there} complete, {cases - there} not solved"
    table = read(tmp_path / "study.nc")
    assert table.attrs["complete"] == 0 and int((table["outcome"] == "not solved").sum()) == cases - there
    assert int(np.isnan(table["shift"]).sum()) == cases - there
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE and read(tmp_path / "study.nc").attrs["complete"] == 1


def test_a_long_case_is_interrupted_within_an_increment(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='friction%mu', values=0.7 /\n", nodes=1501, cycles=200)
    process = start("study.nml", cwd=tmp_path)
    while process.poll() is None and not (tmp_path / "study.sqlite-wal").exists():
        time.sleep(0.01)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    assert process.returncode == INTERRUPTED and cases_kept(tmp_path) == 0


def test_two_at_once(tmp_path):
    write(tmp_path)
    with contextlib.closing(Store(tmp_path / "study.sqlite")):
        done = run("study.nml", cwd=tmp_path)
    assert done.returncode == INPUT and "study.sqlite: cannot save solved cases: another study is using it" in done.stderr


def limited(size):
    """Limit the size of files of a process, to simulate a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def test_a_full_disk(tmp_path):
    """There is a message, saved cases stay, and the same command continues."""
    cases = long_study(tmp_path)
    done = run("study.nml", "--workers", 2, cwd=tmp_path, preexec_fn=limited(80_000))
    assert done.returncode == INPUT and "study.sqlite: cannot save solved cases: " in done.stderr, done.stderr
    there = cases_kept(tmp_path)
    assert 0 < there < cases and not (tmp_path / "study.nc").exists()
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE and cases_kept(tmp_path) == cases
    before = (tmp_path / "study.nc").read_bytes()
    done = run("study.nml", cwd=tmp_path, preexec_fn=limited(60_000))
    assert done.returncode == INPUT and "study.nc" in done.stderr and done.stdout == ""
    assert (tmp_path / "study.nc").read_bytes() == before and not list(tmp_path.glob("*.part*"))


def test_other_files_are_not_replaced(tmp_path, capsys, monkeypatch):
    write(tmp_path)
    monkeypatch.chdir(tmp_path)
    subprocess.run([MFV_RUN, "base.nml"], cwd=tmp_path, capture_output=True)
    (tmp_path / "base.h5").rename(tmp_path / "study.h5")
    for name, words in (
        ("study.h5", "is an HDF5 file, not overwritten"),
        ("study.nml", "must end with .nc or .h5 or .csv"),
        ("no/study.nc", "no does not exist or is not a directory"),
    ):
        for option in ([], ["--again"], ["--list"]):
            assert main(["study", "study.nml", "-o", name, *option]) == INPUT
            printed, said = capsys.readouterr()
            assert words in said and printed == "", said
    for content, words in ((b"my diary\n" * 100, "file is not a database"), (None, "it belongs to another program")):
        (tmp_path / "study.sqlite").unlink(missing_ok=True)
        if content is None:
            with contextlib.closing(sqlite3.connect(tmp_path / "study.sqlite")) as connection:
                connection.execute("CREATE TABLE diary (day)")
        else:
            (tmp_path / "study.sqlite").write_bytes(content)
        before = (tmp_path / "study.sqlite").read_bytes()
        for option in ([], ["--again"], ["--so-far"]):
            assert main(["study", "study.nml", *option]) == INPUT
            said = capsys.readouterr().err
            assert words in said, said
        assert (tmp_path / "study.sqlite").read_bytes() == before


def test_values_that_do_not_go_together_are_told(tmp_path):
    write(
        tmp_path,
        "&sweep base='base.nml' /\n&vary key='solver%algorithm', values='mfv', 'conventional' /\n"
        "&vary key='solver%stepping', values='auto', 'nominal' /\n",
    )
    done = run("study.nml", cwd=tmp_path)
    assert done.returncode == COMPLETE and "4 cases: 3 complete, 1 input error" in done.stdout
    assert "case 4 (base='base.nml', solver%algorithm='conventional', solver%stepping='nominal'): base.nml" in done.stdout


def test_whole_results(tmp_path):
    write(tmp_path, STUDY.replace("reference='full'", "file='out/table.nc', states='all'"))
    (tmp_path / "out").mkdir()
    assert run("study.nml", cwd=tmp_path).returncode == COMPLETE
    (tmp_path / "out").rename(tmp_path / "elsewhere")
    table = read(tmp_path / "elsewhere/table.nc")
    names = table["result_file"].values.ravel()
    assert len(set(names)) == CASES
    for number in (1, 14):
        result = mfv.read(tmp_path / "elsewhere" / names[number - 1])
        assert result.summary.shift == table["shift"].values.ravel()[number - 1]


def test_example(tmp_path):
    table = read_study(ROOT / "examples/study.nml").run()
    assert table.attrs["cases_complete"] == table.attrs["cases"] == 36
    # Dissertation section 6.4: decoupled dissipation is 20 to 50 % above that of full coupling.
    ratio = table["dissipation_ratio"].sel({"scene%coupling": ["goodman", "none"]})
    assert ratio.min() > 1.1 and ratio.max() < 1.5


def test_warnings_reach_the_table(tmp_path):
    """What is not resolved is named at the end, in the table, and after a restart; with --estimate every quantity has its bar or NaN."""
    (tmp_path / "pad.nml").write_text(PAD)
    (tmp_path / "study.nml").write_text(PAD_STUDY)
    told = "1 of 3 cases have warnings, 1 of them quantities that are not resolved: see the columns warnings and unresolved\n"
    for option in ([], ["--so-far"], ["--again"]):
        done = run("study.nml", *option, cwd=tmp_path)
        assert (
            done.returncode == COMPLETE and told in done.stdout and "case 1 (base='pad.nml', Q=6.5): slip zones have" in done.stdout
        )
        table = read(tmp_path / "study.nc")
        assert table.attrs["cases_flagged"] == 1 and "error_estimate" not in table
        assert [bool(text) for text in table["warnings"].values] == [True, False, False]
        assert (
            "cycle_dissipation" in table["unresolved"].values[0].split() and "approach" not in table["unresolved"].values[0].split()
        )
    done = run("study.nml", "--estimate", "-o", "bars.csv", cwd=tmp_path)
    assert done.returncode == COMPLETE and told in done.stdout
    with open(tmp_path / "bars.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["error_estimate"] for row in rows] == ["yes"] * 3 and rows[0]["cycle_dissipation_error [N]"] == ""
    bars = [float(row["cycle_dissipation_error [N]"]) / float(row["cycle_dissipation [N]"]) for row in rows[1:]]
    assert 0.0 < bars[1] < bars[0] < 0.1 and all(float(row["approach_error [mm]"]) > 0.0 for row in rows)


def test_a_table_is_drawn(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pad.nml").write_text(PAD)
    (tmp_path / "study.nml").write_text(PAD_STUDY)
    assert main(["study", "study.nml"]) == COMPLETE and main(["plot", "study.nc"]) == COMPLETE
    assert (tmp_path / "study.png").stat().st_size > 10_000
    capsys.readouterr()
    for options, words in (
        (["--column", "lower_tensio"], "no column 'lower_tensio' in the table; did you mean lower_tension?"),
        (["--over", "R"], "no axis of numbers 'R' in the table; did you mean"),
        (["--stress", "von_mises"], "the table of a study has no --stress"),
    ):
        assert main(["plot", "study.nc", *options]) == INPUT
        assert words.split("; did")[0] in capsys.readouterr().err
    (tmp_path / "single.nml").write_text("&sweep base='pad.nml' /\n&vary key='scene%coupling', values='none' /\n")
    assert main(["study", "single.nml"]) == COMPLETE
    for options, words in (
        (
            [],
            "none of cycle_dissipation, dissipation, lower_tension, contact_length, peak_pressure, approach varies; name a column",
        ),
        (["--column", "approach"], "the table has no axis of numbers to draw over"),
    ):
        assert main(["plot", "single.nc", *options]) == INPUT
        assert words in capsys.readouterr().err


def test_the_study_in_the_help_is_one(tmp_path):
    told = run("--help", cwd=tmp_path).stdout
    text = re.search(r"^  &sweep.*?\n\n", told, re.MULTILINE | re.DOTALL)
    (tmp_path / "mindlin.nml").write_text((ROOT / "examples/mindlin.nml").read_text())
    (tmp_path / "study.nml").write_text(text[0])
    done = run("study.nml", "--list", cwd=tmp_path)
    assert done.returncode == COMPLETE and "study.nml is valid: 90 cases" in done.stdout, done.stderr


def test_every_key_is_documented():
    text = (ROOT / "docs/studies.md").read_text()
    assert all(f"`{name}" in text for keys in KEYS.values() for name in keys)


def test_texts_in_a_csv_are_no_formulas(tmp_path):
    """Names of bases and of columns that a spreadsheet would evaluate; numbers stay numbers."""
    names = ["=1+1.nml", "+a.nml", "-b.nml", "@c.nml", "d.nml"]
    write(tmp_path)
    for name in names:
        (tmp_path / name).write_text((tmp_path / "base.nml").read_text())
    bases = ", ".join(f"'{name}'" for name in names)
    study = f"&sweep base={bases} /\n&vary key='step(3)%tangential_force', values=-2.8e-4, -1.5e-4, name='=Q' /\n"
    (tmp_path / "study.nml").write_text(study)
    assert run("study.nml", "-o", "out.csv", cwd=tmp_path).returncode == COMPLETE
    with open(tmp_path / "out.csv", newline="") as file:
        header, *rows = csv.reader(file)
    assert "'=Q [N/mm]" in header and len(rows) == 10
    forces = {float(row[header.index("'=Q [N/mm]")]) for row in rows}
    assert forces == {-2.8e-4, -1.5e-4}
    for cell in (*header, *(cell for row in rows for cell in row)):
        if cell.startswith(("=", "+", "-", "@")):
            float(cell)
    assert {row[header.index("base")].removeprefix("'") for row in rows} >= {"=1+1.nml", "d.nml"}
