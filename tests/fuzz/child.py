"""A process that is fuzzed: it takes commands and answers them, or dies, or hangs; then it is begun anew."""

from __future__ import annotations

import os
import re
import select
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

#: Signature of a case without an answer.
HANG = "no answer in time"

HERE = Path(__file__).resolve().parent


class Finding(Exception):
    """A crash, a hang, a leak, or an answer that must not be. `signature` is the same for what has the same cause."""

    def __init__(self, signature: str, details: str = "") -> None:
        super().__init__(signature)
        self.signature = signature
        self.details = details


@dataclass
class Answer:
    """What a command has led to. `residual`: largest of the certificate, -1 where nothing was solved."""

    status: int
    seconds: float
    residual: float
    message: str


class Child:
    """fuzz_target, or read_back.py in its place, in a folder of its own."""

    def __init__(self, command: list[str], folder: Path, patience: float, finds_leaks: bool) -> None:
        """`patience`: seconds after which a case counts as a hang."""
        self._command, self._folder, self._patience = command, folder, patience
        self._environment = os.environ | {
            "OPENBLAS_NUM_THREADS": "1",
            "ASAN_OPTIONS": f"detect_leaks={int(finds_leaks)}:allocator_may_return_null=1:max_allocation_size_mb=3000:handle_abort=1",
            "LSAN_OPTIONS": f"suppressions={HERE / 'leaks.supp'}:print_suppressions=0",
            "UBSAN_OPTIONS": "print_stacktrace=1",
        }
        self._process: subprocess.Popen[bytes] | None = None

    def ask(self, command: str) -> str:
        """The line that answers a command. Raises Finding where the process dies or takes too long."""
        process = self._process or self._start()
        assert process.stdin and process.stdout
        process.stdin.write(command.encode() + b"\n")
        process.stdin.flush()
        return self._line(process)

    def do(self, target: str, path: Path) -> Answer:
        """Have a file read by a target."""
        line = self.ask(f"{target} {path}")
        parts = line.split("\t", 3)
        if len(parts) != 4:
            self.stop()
            raise Finding(line.strip() or "an answer that is none")
        return Answer(int(parts[0]), float(parts[1]), float(parts[2]), parts[3].strip())

    def stop(self) -> None:
        """End the process."""
        if self._process:
            self._process.kill()
            self._process.wait()
            self._process.stdout.close()  # type: ignore[union-attr]
            self._process.stdin.close()  # type: ignore[union-attr]
            self._errors.close()
            self._process = None

    def errors(self) -> str:
        """What the process has written to its standard error since this was asked last."""
        self._errors.seek(0)
        text = self._errors.read().decode(errors="replace")
        self._errors.seek(0)
        self._errors.truncate()
        return text

    def _start(self) -> subprocess.Popen[bytes]:
        # Appended to, so that what is written after errors() has emptied the file comes to its beginning.
        self._errors = tempfile.TemporaryFile("a+b")
        self._process = subprocess.Popen(
            self._command,
            cwd=self._folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=self._environment,
        )
        if self._line(self._process).strip() != "fuzz_target":
            sys.exit(f"{self._command[0]} does not start: {self.errors()}")
        return self._process

    def _line(self, process: subprocess.Popen[bytes]) -> str:
        assert process.stdout
        if not select.select([process.stdout], [], [], self._patience)[0]:
            self.stop()
            raise Finding(HANG)
        line = process.stdout.readline()
        if line:
            return line.decode(errors="replace")
        code = process.wait()
        details = self.errors()
        self.stop()
        raise Finding(signature_of(details) or f"died with code {code}", details)


def signature_of(report: str) -> str:
    """The cause in the report of a sanitizer or of the Fortran library: its summary, and the first procedures of MFV in it.

    An overflow of an integer(kind=8) is none: gfortran computes the old size of an allocatable that is not allocated from whatever
    its bounds are when it is assigned to, and drops the number.
    """
    errors = [line for line in report.splitlines() if "runtime error: " in line and "type 'integer(kind=8)'" not in line]
    match = re.search(r"SUMMARY: (.*)|Error allocating.*", report)
    cause = errors[0] if errors else match[0] if match else ""
    return " < ".join([re.sub(r"\d{4,}", "N", cause.strip()[:200]), *_procedures(report)]) if cause else ""


def leak_of(report: str) -> str:
    """The procedures that leak, the first ones that are not those of libraries."""
    return " < ".join(_procedures(report)) or "outside MFV"


def _procedures(report: str) -> list[str]:
    return re.findall(r"in (__mfv_\w+|mfv_\w+|fuzz_\w+)", report)[:2]
