"""Fuzz MFV: python tests/fuzz/run.py --cases 2000 [--seed 1] [--targets case,matrix] [--build build/sanitize]

Hypothesis makes the cases from the seed and shrinks what fails; fuzz_target (in BUILD/bin, built with sanitizers by the preset
sanitize) reads them. Of every target as many cases as its share says. A finding is a crash, a report of a sanitizer, a case
without an answer within --patience, a leak, or a certificate that is worse than --residual; the smallest case that shows it is
kept in --findings, with a text that has its seed and the report. Exit code 1 where there are findings.

--found reads every case in tests/fuzz/found instead: the regressions.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random as random_module
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import files
import texts
from child import HANG, Answer, Child, Finding, leak_of, signature_of
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from hypothesis.errors import Flaky

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MFV_COMPLETE = 0
#: Cases between two looks for leaks, which take a tenth of a second.
CHUNK = 250
#: Seconds that shrinking one finding may take.
SHRINKING = 20.0


@dataclass
class Target:
    """What reads a kind of file: its command, the ending of its files, its share of the cases, and how a case is made."""

    command: str
    ending: str
    share: float
    make: Callable[[Any], bytes]
    in_python: bool = False


@dataclass
class Count:
    """What has become of the cases of one target."""

    cases: int = 0
    accepted: int = 0
    solved: int = 0
    slowest: float = 0.0
    residual: float = 0.0
    seconds: float = 0.0
    findings: Counter[str] = field(default_factory=Counter)


class Fuzzer:
    """All targets, and where they stand."""

    def __init__(self, options: argparse.Namespace, folder: Path) -> None:
        self.options, self.folder = options, folder
        target = options.build / "bin/fuzz_target"
        self.finds_leaks = not options.no_leaks
        self.child = Child([str(target)], folder, options.patience, self.finds_leaks)
        python = Child([sys.executable, str(HERE / "read_back.py")], folder, options.patience, False)
        python._environment["PYTHONPATH"] = str(ROOT / "python")
        self.python_child = python
        self.targets = self._targets()
        self.counts = {name: Count() for name in self.targets}
        self.in_flight = b""

    def _targets(self) -> dict[str, Target]:
        """All of them, with what they begin from in the folder."""
        run = self.options.build / "bin/mfv_run"
        keys = texts.key_table(_output([run, "--keys"], self.folder))
        (self.folder / "base.nml").write_text(texts.SMALL)
        for name in ("columns.txt", "three_bumps.txt", "profile.txt"):
            (self.folder / name).write_text(texts.COLUMNS[0])
        (self.folder / "matrix.h5").write_bytes(files.matrix_bytes())
        _output([run, "base.nml"], self.folder)
        result = (self.folder / "base.h5").read_bytes()
        matrices = [files.matrix_bytes(), files.matrix_bytes(libver="latest")]
        lines = [token.encode() for token in texts.TOKENS + list(texts.VALUES)]

        def stress(random: Any) -> bytes:
            return files.odd_attributes(random, result) if random.randint(0, 1) else files.damaged(random, result)

        return {
            "case": Target("case", "nml", 0.30, lambda random: texts.changed_text(random, texts.cases(), keys)),
            "case_bytes": Target("case", "nml", 0.22, lambda random: texts.changed_whole(random, texts.cases())),
            "columns": Target(
                "columns", "txt", 0.05, lambda random: texts.changed_bytes(random, random.choice(texts.COLUMNS).encode(), lines)
            ),
            "matrix": Target("matrix", "h5", 0.10, lambda random: files.odd_hdf5(random, files.right_matrix())),
            "matrix_bytes": Target("matrix", "h5", 0.08, lambda random: files.damaged(random, random.choice(matrices))),
            "stress": Target("stress", "h5", 0.03, stress),
            "read": Target("read", "h5", 0.01, stress, in_python=True),
        }

    def try_case(self, name: str, data: bytes, looks_for_leaks: bool = False) -> Answer:
        """Have a case read. Raises Finding."""
        target, count = self.targets[name], self.counts[name]
        child = self.python_child if target.in_python else self.child
        path = self.folder / f"fuzzed_{name}.{target.ending}"  # never one of the files that cases name
        path.write_bytes(data)
        answer = child.do(target.command, path)
        if signature := signature_of(report := child.errors()):
            raise Finding(signature, report)
        if looks_for_leaks and not target.in_python and child.ask("leaks").strip() == "1":
            report = child.errors()
            child.stop()
            raise Finding("leak: " + leak_of(report), report)
        if answer.status < 0:
            raise Finding(answer.message)
        if answer.status == MFV_COMPLETE and answer.residual > self.options.residual:
            raise Finding(f"certificate beyond {self.options.residual:g}", f"{answer.residual:g}")
        count.accepted += answer.status == MFV_COMPLETE
        count.solved += answer.residual >= 0
        count.slowest = max(count.slowest, answer.seconds)
        if answer.status == MFV_COMPLETE:
            count.residual = max(count.residual, answer.residual)
        return answer

    def fuzz(self, name: str, cases: int) -> None:
        """So many cases of one target."""
        target, count, chunk = self.targets[name], self.counts[name], 0
        started = time.monotonic()
        while count.cases < cases:
            number = min(CHUNK, cases - count.cases)
            chunk_seed = f"{self.options.seed}-{name}-{chunk}"
            self._chunk(name, target, number, chunk_seed, shrinks=True)
            if self.finds_leaks and not target.in_python and self.child.ask("leaks").strip() == "1":
                report = self.child.errors()
                self._chunk(name, target, number, chunk_seed, shrinks=True, looks_for_leaks=True)
                if not any(signature.startswith("leak") for signature in count.findings):
                    self._keep(name, chunk_seed, Finding("leak of more than one case: " + leak_of(report), report), b"")
                self.child.stop()
            count.cases += number
            chunk += 1
            if sys.stderr.isatty():
                print(
                    f"\r{name}: {count.cases} of {cases}, {sum(count.findings.values())} findings ",
                    end="",
                    file=sys.stderr,
                    flush=True,
                )
            if self.options.seconds and time.monotonic() - started > self.options.seconds:
                break
        count.seconds = time.monotonic() - started
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr)

    def _chunk(self, name: str, target: Target, number: int, chunk_seed: str, shrinks: bool, looks_for_leaks: bool = False) -> None:
        """Cases of one seed; what fails is kept and does not end them."""
        worst: list[tuple[Finding, bytes]] = []
        first = [0.0]
        known = self.counts[name].findings

        @seed(int.from_bytes(hashlib.sha256(chunk_seed.encode()).digest()[:8], "big"))
        @settings(
            max_examples=number,
            database=None,
            deadline=None,
            suppress_health_check=list(HealthCheck),
            report_multiple_bugs=False,
            phases=(Phase.generate, Phase.shrink) if shrinks else (Phase.generate,),
        )
        @given(st.randoms(use_true_random=False))
        def one(random: random_module.Random) -> None:
            if worst and time.monotonic() - first[0] > SHRINKING:
                return
            data = target.make(random)
            if texts.TOO_LONG.search(data) and target.ending == "nml":
                return
            try:
                self.try_case(name, data, looks_for_leaks)
            except Finding as finding:
                if finding.signature == HANG:  # too slow to shrink
                    self._keep(name, chunk_seed, finding, data)
                    return
                if finding.signature in known:
                    known[finding.signature] += 1
                    return
                if worst and worst[0][0].signature != finding.signature:
                    return
                if not worst:
                    first[0] = time.monotonic()
                worst[:] = [(finding, data)]
                raise

        while True:
            worst.clear()
            try:
                one()
                return
            except (Finding, Flaky):  # flaky: what depends on cases before it, and what was shrunk long enough
                self._keep(name, chunk_seed, *worst[0])

    def _keep(self, name: str, chunk_seed: str, finding: Finding, data: bytes) -> None:
        """Keep the smallest case of a finding, with its report."""
        self.counts[name].findings[finding.signature] += 1
        self.options.findings.mkdir(parents=True, exist_ok=True)
        distinct = data if finding.signature == HANG else finding.signature.encode()
        stem = self.options.findings / f"{name}-{hashlib.sha256(distinct).hexdigest()[:8]}"
        path = stem.with_suffix("." + self.targets[name].ending)
        path.write_bytes(data)
        stem.with_suffix(".report").write_text(f"seed {chunk_seed}\n{finding.signature}\n{finding.details}\n")
        print(f"{name}: {finding.signature}\n   {path} (seed {chunk_seed})", flush=True)

    def stop(self) -> None:
        """End the children."""
        self.child.stop()
        self.python_child.stop()


def _output(command: list[object], folder: Path) -> str:
    environment = os.environ | {"ASAN_OPTIONS": "detect_leaks=0", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(
        [str(word) for word in command], cwd=folder, check=True, capture_output=True, text=True, env=environment
    ).stdout


def read_found(fuzzer: Fuzzer) -> int:
    """Read every case that was found before. Number of those that fail again."""
    failed, paths = 0, sorted(path for path in (HERE / "found").iterdir() if path.suffix != ".md")
    for path in paths:
        name = path.name.split("-")[0]
        try:
            answer = fuzzer.try_case(name, path.read_bytes(), looks_for_leaks=fuzzer.finds_leaks)
            print(f"{path.name}: {answer.status} {answer.message}")
        except Finding as finding:
            failed += 1
            print(f"{path.name}: {finding.signature}\n{finding.details}")
    print(f"{len(paths) - failed} passed, {failed} failed")
    return failed


def main() -> int:
    """Fuzz, and say what came out."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000, help="cases in all targets together")
    parser.add_argument("--seed", default="1", help="text or number that decides all cases")
    parser.add_argument("--targets", default="", help="some of the targets, separated by commas; all cases are then theirs")
    parser.add_argument("--build", type=Path, default=ROOT / "build/sanitize", help="folder of a build")
    parser.add_argument("--findings", type=Path, default=ROOT / "build/fuzz", help="folder that findings are kept in")
    parser.add_argument("--patience", type=float, default=20.0, help="seconds after which a case hangs")
    parser.add_argument("--residual", type=float, default=1e-6, help="largest residual that a certificate may have")
    parser.add_argument("--seconds", type=float, default=0.0, help="end a target after as many seconds; 0: never")
    parser.add_argument("--no-leaks", action="store_true", help="do not look for leaks")
    parser.add_argument("--found", action="store_true", help="read the cases in tests/fuzz/found")
    options = parser.parse_args()
    options.build, options.findings = options.build.resolve(), options.findings.resolve()
    shared = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    folder = Path(tempfile.mkdtemp(prefix="mfv_fuzz_", dir=shared))
    try:
        fuzzer = Fuzzer(options, folder)
        try:
            if options.found:
                return min(1, read_found(fuzzer))
            names = options.targets.split(",") if options.targets else list(fuzzer.targets)
            total = sum(fuzzer.targets[name].share for name in names)
            for name in names:
                fuzzer.fuzz(name, max(1, round(options.cases * fuzzer.targets[name].share / total)))
                count = fuzzer.counts[name]
                print(
                    f"{name:14}{count.cases:8} cases {count.accepted:7} accepted {count.solved:7} solved, slowest {count.slowest:6.2f} s, "
                    f"largest residual {count.residual:.1e}, {count.seconds:6.0f} s, {len(count.findings)} findings",
                    flush=True,
                )
        finally:
            fuzzer.stop()
        found = sum(len(count.findings) for count in fuzzer.counts.values())
        print(f"{sum(count.cases for count in fuzzer.counts.values())} cases, {found} findings")
        return 1 if found else 0
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    sys.exit(main())
