"""Measure mfv_sweep: what 2 threads and 2 ranks gain over 1, and that kill -9 costs nothing but the cases on their way. Prints a
Markdown table for docs/sweep.md. Takes some minutes on a quiet machine.

cmake --preset release && cmake --build --preset release --target mfv_sweep
cmake -S . -B build/mpi -DMFV_MPI=ON -DBUILD_TESTING=OFF && cmake --build build/mpi --target mfv_sweep
build/venv/bin/python bench/sweep.py
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import re
import statistics
import struct
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = os.environ | {
    "OPENBLAS_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}
BASE = """&scene coupling='full' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width=0.0125 /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step force_ratio=0.5 /
&step force_ratio=-0.5, cycles=2 /
"""
SWEEP = """&sweep base='base.nml', reference='full' /
&vary key='friction%mu', from=0.2, to=0.8, count={count} /
&vary key='step(2)%force_ratio', 'step(3)%force_ratio', factor=1, -1, from=0.1, to=0.9, count=20, name='force_ratio' /
&vary key='scene%coupling', values='full', 'goodman' /
"""
PER_COUNT = 40  # cases for each value of the first axis


def main() -> None:
    """Measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bin/mfv_sweep", help="with or without MPI")
    parser.add_argument("--mpi-program", type=Path, default=ROOT / "build/mpi/bin/mfv_sweep", help="with MPI")
    parser.add_argument("--cases", type=int, default=1000, help=f"a multiple of {PER_COUNT}")
    parser.add_argument("--nodes", type=int, default=221, help="size of a case")
    parser.add_argument("--rounds", type=int, default=3, help="how often all runs are repeated, in turn")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "base.nml").write_text(BASE.format(nodes=options.nodes))
        (folder / "study.nml").write_text(SWEEP.format(count=options.cases // PER_COUNT))
        cases = options.cases // PER_COUNT * PER_COUNT
        digest = efficiency(options, folder, cases)
        kills(options, folder, cases, digest)


def efficiency(options: argparse.Namespace, folder: Path, cases: int) -> str:
    """Times of 1 and 2 threads, and of 1 and 2 ranks, in turn; the digest that all tables have."""
    commands = {"1 thread": [options.program, "--threads", "1"], "2 threads": [options.program, "--threads", "2"]}
    if "with MPI" in output_of([options.mpi_program, "--version"]):
        for number in (1, 2):
            launcher = ["mpirun", "--oversubscribe", "-n", str(number)]
            commands[f"{number} rank" + "s" * (number > 1)] = [*launcher, options.mpi_program, "--threads", "1"]
    times: dict[str, list[float]] = {name: [] for name in commands}
    digests = set()
    for _ in range(options.rounds):
        for name, command in commands.items():
            started = time.perf_counter()
            subprocess.run([*command, "--again", "study.nml"], cwd=folder, env=ENVIRONMENT, check=True, capture_output=True)
            times[name].append(time.perf_counter() - started)
            digests.add(hashlib.sha256((folder / "study.h5").read_bytes()).hexdigest())
    print(f"{cases} cases with {options.nodes} nodes, {options.rounds} rounds in turn, {os.cpu_count()} processors:\n")
    print("| | seconds, least | per case, ms | T1/(2 T2), median of the rounds |\n| --- | --- | --- | --- |")
    for name, values in times.items():
        gain = ""
        if name.startswith("2"):
            alone = times["1 thread" if "thread" in name else "1 rank"]
            gain = f"{statistics.median(one / (2 * two) for one, two in zip(alone, values)):.3f}"
        print(f"| {name} | {min(values):.2f} | {1e3 * min(values) / cases:.2f} | {gain} |")
    print(f"\nDifferent tables: {len(digests)} (1: all have the same bytes).")
    if len(digests) != 1:
        raise SystemExit("the tables differ")
    return digests.pop()


def kills(options: argparse.Namespace, folder: Path, cases: int, digest: str) -> None:
    """Kill a sweep at random moments, go on, and compare the table in the end."""
    chance = random.Random(options.seed)
    for path in folder.glob("study.h5*"):
        path.unlink()
    journal = folder / "study.h5.journal"
    before: list[int] = []
    print(f"\n| kill -9 | after, s | cases before | cases after | lost | done twice |\n| --- | --- | --- | --- | --- | --- |")
    started = time.perf_counter()
    subprocess.run([options.program, "study.nml"], cwd=folder, env=ENVIRONMENT, check=True, capture_output=True)
    whole = time.perf_counter() - started
    (folder / "study.h5").unlink()
    for number in range(1, options.kills + 1):
        run = subprocess.Popen(
            [options.program, "study.nml"], cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        after_seconds = chance.uniform(0.0, 1.5 * whole / options.kills)
        time.sleep(after_seconds)
        run.kill()
        run.wait()
        if (folder / "study.h5").exists():
            print(f"| {number} | {after_seconds:.2f} | {len(before)} | all | | |")
            break
        after = numbers_in(journal)
        lost, twice = len(set(before) - set(after)), len(after) - len(set(after))
        print(f"| {number} | {after_seconds:.2f} | {len(before)} | {len(after)} | {lost} | {twice} |")
        if lost or twice:
            raise SystemExit("cases were lost or done twice")
        before = after
    said = output_of([options.program, "study.nml"], folder)
    there = re.match(r"(\d+) of", said)
    same = hashlib.sha256((folder / "study.h5").read_bytes()).hexdigest() == digest
    print(f"\nThe last run found {there[1] if there else 'no'} cases of {cases}; the table has "
          f"{'the same bytes as' if same else 'OTHER BYTES THAN'} that of an undisturbed run.")
    if not same:
        raise SystemExit("the tables differ")


def numbers_in(journal: Path) -> list[int]:
    """Numbers of the cases in the whole records of a journal (docs/sweep.md)."""
    data = journal.read_bytes() if journal.exists() else b""
    at, numbers = data.find(b"\n") + 1, []
    while at > 0 and at + 4 <= len(data):
        (length,) = struct.unpack_from("<i", data, at)
        if at + 4 + length + 8 > len(data):
            break
        numbers.append(struct.unpack_from("<i", data, at + 4)[0])
        at += 4 + length + 8
    return numbers


def output_of(command: list[str | Path], folder: Path | None = None) -> str:
    """What a command prints; nothing where it cannot be run."""
    try:
        return subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True).stdout
    except OSError:
        return ""


if __name__ == "__main__":
    main()
