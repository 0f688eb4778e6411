"""Measure studies: overhead of a case with every executor; check that kill -9 loses only the cases in progress.
Prints Markdown tables. A quarter of an hour. build/venv/bin/python bench/study.py

Overhead of a case: workers x (wall time less that of the same study with 2 cases) / (cases - 2), less the time per case when
the same jobs are solved one after another in this process, without a study, in the same round. Every run keeps its cases in a
store and writes its table. A study is killed at random times; a trigger in its store rejects a case that is solved twice.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import os
import random
import shutil
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
os.environ.update(OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
os.environ["PYTHONPATH"] = str(ROOT / "python")
sys.path.insert(0, str(ROOT / "python"))

import xarray

from mfv.studies.cases import solve_unless
from mfv.studies.dataset import write
from mfv.studies.namelist import read_study

BASE = """&scene coupling='full' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width=0.0125 /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step force_ratio=0.5 /
&step force_ratio=-0.5, cycles=2 /
"""
STUDY = """&sweep base='base.nml', reference='full' /
&vary key='friction%mu', from=0.2, to=0.8, count={} /
&vary key='step(2)%force_ratio', 'step(3)%force_ratio', factor=1, -1, from=0.1, to=0.9, count={}, name='force_ratio' /
&vary key='scene%coupling', values='full', 'goodman' /
"""
COMMAND = (sys.executable, "-m", "mfv", "study")
TWICE = "BEFORE INSERT ON cases WHEN NEW.key IN (SELECT key FROM cases) BEGIN SELECT RAISE(ABORT, 'solved twice'); END"
Solve = Callable[[Path], object]


def main() -> None:
    """Measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000, help="a multiple of 40")
    parser.add_argument("--nodes", type=int, nargs="+", default=[41, 221], help="sizes of a case: about 1 ms and 26 ms")
    parser.add_argument("--rounds", type=int, default=3, help="number of repetitions of all runs")
    parser.add_argument("--kills", type=int, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for stem, counts in (("study", (options.cases // 40, 20)), ("two", (1, 1))):
            (folder / f"{stem}.nml").write_text(STUDY.format(*counts))
        for nodes in options.nodes:
            (folder / "base.nml").write_text(BASE.format(nodes=nodes))
            print(f"## {options.cases} cases with {nodes} nodes, {options.rounds} rounds, {os.cpu_count()} processors\n")
            print_overheads(ways(), folder, options.rounds)
        print_kills(folder, options.kills, random.Random(1))


def ways() -> dict[str, tuple[int, Solve]]:
    """Workers of every executor, and the function that solves a study."""
    here = (("threads", 1), ("threads", 2), ("processes", 2), ("dask", 2))
    found = {f"{name}, {workers}": (workers, functools.partial(solve_here, name, workers)) for name, workers in here}
    launcher = ("mpiexec", "-n", "3", "--oversubscribe", sys.executable, "-m", "mpi4py.futures")
    found["mpi, 2"] = 2, functools.partial(call, (*launcher, *COMMAND[1:], "--executor", "mpi"))
    return found


def solve_here(executor: str, workers: int, text: Path) -> None:
    """Solve a study in this process, and write its table."""
    table = read_study(text).run(executor=executor, workers=workers, store=text.with_suffix(".sqlite"))
    write(table, text.with_suffix(".nc"))


def call(command: tuple[str, ...], text: Path) -> None:
    """Solve a study by a command."""
    subprocess.run([*command, text.name], cwd=text.parent, check=True, stdout=subprocess.DEVNULL)


def seconds(solve: Solve, text: Path) -> float:
    """Time of a study without saved cases."""
    for path in {*text.parent.glob(f"{text.stem}.*")} - {text}:
        path.unlink()
    started = time.perf_counter()
    solve(text)
    return time.perf_counter() - started


def print_overheads(measured: dict[str, tuple[int, Solve]], folder: Path, rounds: int) -> None:
    """Print start-up and overhead per case of every executor; their tables must be equal."""
    jobs = [study.job(number) for study in [read_study(folder / "study.nml")] for number in range(1, len(study) + 1)]
    solve_here("threads", 1, folder / "two.nml")  # for what is imported on first use
    alone, tables, begun, beside = [], {}, {name: [] for name in measured}, {name: [] for name in measured}
    for _ in range(rounds):
        started = time.perf_counter()
        for job in jobs:
            solve_unless(None, job)
        alone.append(1e3 * (time.perf_counter() - started) / len(jobs))
        for name, (workers, solve) in measured.items():
            begun[name].append(seconds(solve, folder / "two.nml"))
            solving = seconds(solve, folder / "study.nml") - begun[name][-1]
            beside[name].append(1e3 * workers * solving / (len(jobs) - 2) - alone[-1])
            tables[name] = xarray.load_dataset(folder / "study.nc")
    print(f"One after another {told(alone)} ms a case: least, median.\n")
    print("| executor, workers | 2 cases, s: least, median | overhead a case, ms: least, median |\n| --- | --- | --- |")
    for name in measured:
        print(f"| {name} | {told(begun[name])} | {told(beside[name])} |")
    others = [name for name, table in tables.items() if not table.identical(tables["threads, 1"])]
    print(f"\nTables other than that of 'threads, 1': {', '.join(others) or 'none'}.\n")


def told(values: list[float]) -> str:
    """The minimum and the median."""
    return f"{min(values):.2f}, {statistics.median(values):.2f}"


def print_kills(folder: Path, count: int, chance: random.Random) -> None:
    """Kill a study at random times, continue it, and compare the final table."""
    text, store = folder / "study.nml", folder / "study.sqlite"
    start, whole = (seconds(functools.partial(call, COMMAND), path) for path in (folder / "two.nml", text))
    undisturbed = xarray.load_dataset(folder / "study.nc")
    with contextlib.closing(sqlite3.connect(store)) as connection:
        connection.executescript(f"DELETE FROM cases; CREATE TRIGGER once {TWICE}")
    kept: set[str] = set()
    print(f"## kill -9 of a study that takes {whole:.1f} s\n\n| kill | after, s | cases kept |\n| --- | --- | --- |")
    for number in range(1, count + 1):
        run = subprocess.Popen([*COMMAND, text.name], cwd=folder, stdout=subprocess.DEVNULL)
        time.sleep(moment := chance.uniform(0.5 * start, start + 1.5 * (whole - start) / count))
        run.kill()
        end = "" if run.wait() < 0 else f" (it had ended with {run.returncode})"
        before, kept = kept, names_in(store)
        print(f"| {number} | {moment:.2f}{end} | {len(kept)}{'' if before <= kept else ', SOME WERE LOST'} |")
    call(COMMAND, text)
    xarray.testing.assert_identical(xarray.load_dataset(folder / "study.nc"), undisturbed)
    print("\nA last run gave the table of the undisturbed run.")


def names_in(store: Path) -> set[str]:
    """Hashes of the cases in a store, read from a copy, so that the next run recovers the original."""
    with tempfile.TemporaryDirectory() as place:
        for path in store.parent.glob(f"{store.name}*"):
            shutil.copy(path, place)
        with contextlib.closing(sqlite3.connect(Path(place) / store.name)) as connection:
            return {name for (name,) in connection.execute("SELECT key FROM cases")}


if __name__ == "__main__":
    main()
