#!/usr/bin/env python3
"""Turn a pFUnit test file into Fortran for the stand-in: the suite's module and a program that runs its tests.

It takes a subset of what pFUnit 4.14 takes and refuses the rest with "file.pf:line: error: reason": a file that passes
here is meant to pass there too.
"""

import argparse
import re
import sys
from pathlib import Path
from typing import NamedTuple, Optional

LONGEST_DIRECTIVE = 120

# Assertions known, each with the number of arguments that it takes at least.
ASSERTIONS = {
    "equal": 2,
    "relativelyequal": 3,
    "true": 1,
    "false": 1,
    "all": 1,
    "any": 1,
    "isfinite": 1,
    "isnan": 1,
    "lessthan": 2,
    "lessthanorequal": 2,
    "greaterthan": 2,
    "greaterthanorequal": 2,
    "fail": 1,
    "exceptionraised": 0,
}


class PfError(Exception):
    """A line of a .pf file that cannot be taken, with its number and the reason."""

    def __init__(self, line: int, reason: str):
        super().__init__(reason)
        self.line = line
        self.reason = reason


class Code(NamedTuple):
    """A line with its comment cut and "_" for each character of a string: columns stay."""

    text: str
    has_comment: bool
    open_quote: str  # the quote of a string that the line leaves open, or nothing


def code_of(line: str, quote: str = "") -> Code:
    """Find the code of a line that begins inside a string opened by `quote`, if any."""
    text = []
    for char in line:
        if quote:
            if char == quote:
                quote = ""
            text.append("_")
        elif char in "'\"":
            quote = char
            text.append("_")
        elif char == "!":
            return Code("".join(text), True, "")
        else:
            text.append(char)
    return Code("".join(text), False, quote)


def count_arguments(number: int, arguments: str, code: str) -> int:
    """Count the arguments in "(...)"; `code` is the same text without its strings."""
    depth = 0
    count = 1 if arguments[1:-1].strip() else 0
    for column, char in enumerate(code):
        if char in "([":
            depth += 1
        elif char in ")]":
            depth -= 1
        elif char == "," and depth == 1:
            count += 1
        if depth == 0 and code[column + 1 :].strip():
            raise PfError(number, "nothing may follow the closing parenthesis of a directive")
    if depth != 0:
        raise PfError(number, "unbalanced parentheses in a directive; it may not continue on the next line")
    return count


class Suite:
    """One .pf file being read: what is to run, and the module's Fortran."""

    def __init__(self, file_name: str):
        self.file_name = file_name
        self.module = Path(file_name).stem
        self.fortran: list[str] = []
        self.tests: list[tuple[str, bool]] = []  # name, and whether it is disabled
        self.fixtures = {"before": "", "after": ""}
        self._module_seen = False
        self._waiting = ""  # the directive whose subroutine must come next
        self._waiting_line = 0
        self._disabled = False

    def read(self, text: str) -> None:
        """Take the whole text of the file."""
        quote = ""
        number = 0
        for number, line in enumerate(text.rstrip("\n").split("\n"), start=1):
            inside_string = bool(quote)
            code = code_of(line, quote)
            quote = code.open_quote if line.rstrip().endswith("&") else ""
            if inside_string or not code.text.strip():
                self.fortran.append(line)
            elif code.text.lstrip().startswith("@"):
                self._directive(number, line, code)
            else:
                self._statement(number, line, code)
        if self._waiting:
            raise PfError(self._waiting_line, f"@{self._waiting} has no subroutine after it")
        if not self._module_seen:
            raise PfError(number, f"no `module {self.module}` in the file")

    def _directive(self, number: int, line: str, code: Code) -> None:
        if len(line) > LONGEST_DIRECTIVE:
            raise PfError(number, f"a directive takes at most {LONGEST_DIRECTIVE} characters, here are {len(line)}")
        if code.has_comment:
            raise PfError(number, "a directive takes no trailing comment")
        if "&" in code.text or line.rstrip().endswith("&"):
            raise PfError(number, "a directive may not continue with &")
        if code.open_quote:
            raise PfError(number, "a string in a directive is not closed")
        parts = re.match(r"(\s*)@(\w*)\s*(.*?)\s*$", line)
        indent, name, arguments = parts.groups()
        keyword = name.lower()
        if keyword in ("test", "before", "after", "disable"):
            self._annotation(number, keyword, arguments)
            self.fortran.append(f"{indent}! @{name}")
        elif keyword.startswith("assert") and keyword[6:] in ASSERTIONS:
            self._assertion(number, indent, name, arguments, code.text[parts.start(3) :].rstrip())
        else:
            raise PfError(number, f"unknown directive @{name}")

    def _annotation(self, number: int, keyword: str, arguments: str) -> None:
        if arguments:
            raise PfError(number, f"@{keyword} takes nothing after it")
        if keyword == "disable":
            if self._waiting != "test":
                raise PfError(number, "@disable may stand only between @test and its subroutine")
            self._disabled = True
            return
        self._expect_nothing_waiting(number)
        if self.fixtures.get(keyword):
            raise PfError(number, f"a second @{keyword}")
        self._waiting = keyword
        self._waiting_line = number
        self._disabled = False

    def _assertion(self, number: int, indent: str, name: str, arguments: str, code: str) -> None:
        self._expect_nothing_waiting(number)
        if not arguments.startswith("("):
            raise PfError(number, f"@{name} needs its arguments in parentheses, if only ()")
        count = count_arguments(number, arguments, code)
        least = ASSERTIONS[name.lower()[6:]]
        if count < least:
            raise PfError(number, f"@{name} takes at least {least} argument(s), here are {count}")
        if least == 0 and count > 0:
            raise PfError(number, f"@{name} takes no argument")
        comma = ", " if count else ""
        self.fortran += [
            f"{indent}call {name}({arguments[1:-1].strip()}{comma}&",
            f"{indent}   & location=SourceLocation('{self.file_name}', {number}))",
            f"{indent}if (anyExceptions()) return",
        ]

    def _statement(self, number: int, line: str, code: Code) -> None:
        if "@" in code.text:
            raise PfError(number, "a directive must be the first on its line, alone")
        if code.text.startswith("#"):
            raise PfError(number, "a preprocessor line: the stand-in compiles without preprocessing")
        self._check_module(number, line)
        if self._waiting:
            self._procedure(number, code.text)
        self.fortran.append(line)

    def _check_module(self, number: int, line: str) -> None:
        """The first statement, and no other, must be `module <name of the file>`, alone."""
        match = re.match(r"\s*module\s+(\w+)(.*)$", line, re.IGNORECASE)
        if match and match[1].lower() in ("procedure", "subroutine", "function") and match[2].strip():
            match = None
        if self._module_seen:
            if match:
                raise PfError(number, "a second module in the file")
            return
        if not match or match[1].lower() != self.module.lower():
            raise PfError(number, f"the first statement must be `module {self.module}`, as the file is named")
        if match[2].strip():
            raise PfError(number, f"nothing may follow `module {self.module}` on its line")
        self._module_seen = True

    def _procedure(self, number: int, code: str) -> None:
        """Take the subroutine that a @test, @before or @after waits for."""
        match = re.match(r"\s*subroutine\s+(\w+)\s*\(\s*\)\s*$", code, re.IGNORECASE)
        if not match:
            what = "not a recursive one" if re.match(r"\s*recursive\b", code, re.IGNORECASE) else "without arguments"
            raise PfError(number, f"after @{self._waiting} must come `subroutine name()`, {what}")
        if self._waiting == "test":
            self.tests.append((match[1], self._disabled))
        else:
            self.fixtures[self._waiting] = match[1]
        self._waiting = ""

    def _expect_nothing_waiting(self, number: int) -> None:
        if self._waiting:
            raise PfError(number, f"the @{self._waiting} of line {self._waiting_line} has no subroutine yet")

    def driver(self) -> list[str]:
        """Lines of the program that runs the tests."""
        before, after = self.fixtures["before"], self.fixtures["after"]
        running = [name for name, disabled in self.tests if not disabled]
        lines = [
            f"!> Runs the tests of {self.file_name}; made by pf_preprocess.py.",
            f"program {self.module}_driver",
            "   use funit, only: anyExceptions, standin_disable, standin_enter, standin_finish, &",
            "      & standin_leave, standin_start",
        ]
        lines += [f"   use {self.module}, only: {name}" for name in [before, *running, after] if name]
        lines += ["   implicit none (type, external)", "", f"   call standin_start('{self.module}')"]
        for name, disabled in self.tests:
            if disabled:
                lines.append(f"   call standin_disable('{name}')")
                continue
            # As pFUnit: after a failed @before, neither the test nor @after runs.
            lines.append(f"   call standin_enter('{name}')")
            lines += [f"   call {before}()"] if before else []
            lines += ["   if (.not. anyExceptions()) then", f"      call {name}()"]
            lines += [f"      call {after}()"] if after else []
            lines += ["   end if", "   call standin_leave()"]
        return lines + ["   call standin_finish()", f"end program {self.module}_driver"]


def main(arguments: Optional[list[str]] = None) -> int:
    """Translate one file; 1, with the reason on stderr, when it cannot be."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", type=Path, help="the .pf file")
    parser.add_argument("--module", type=Path, required=True, help="where the suite's module goes (.f90)")
    parser.add_argument("--driver", type=Path, required=True, help="where the program that runs it goes (.f90)")
    options = parser.parse_args(arguments)
    suite = Suite(options.input.name)
    try:
        suite.read(options.input.read_text(encoding="utf-8"))
    except PfError as error:
        print(f"{options.input}:{error.line}: error: {error.reason}", file=sys.stderr)
        return 1
    options.module.write_text("\n".join(suite.fortran) + "\n", encoding="utf-8")
    options.driver.write_text("\n".join(suite.driver()) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
