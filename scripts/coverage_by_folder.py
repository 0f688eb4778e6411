"""Statements that no test has run, and a table by folder, from gcovr's JSON: coverage_by_folder.py <lines.json>."""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

# gfortran attributes code for types, copies and finalisation to these lines.
NO_CODE = re.compile(r"(end (function|subroutine|module)|use |associate \(|(pure |elemental )*(module|function|subroutine)\b)|^$")
DECLARATION = re.compile(r"(?!allocate|call|if|where|do )[a-z][\w ]*(\(.*\))?[^'=]*::")


def first_lines(text, is_fortran):
    """Number of the line with which the statement of each line begins."""
    first = {}
    for number, _line in enumerate(text, 1):
        goes_on = is_fortran and number > 1 and re.sub(r"\s*(!.*)?$", "", text[number - 2]).endswith("&")
        first[number] = first[number - 1] if goes_on else number
    return first


ran, statements = defaultdict(int), defaultdict(int)
for file in json.loads(Path(sys.argv[1]).read_text())["files"]:
    path = Path(file["file"])
    text = path.read_text().splitlines()
    is_fortran = path.suffix.lower() == ".f90"
    first, counted = first_lines(text, is_fortran), {}
    for line in file["lines"]:  # lines of one statement, and instances of one line, as in a generic procedure, count as one
        number = first[line["line_number"]]
        begin = text[number - 1].strip()
        if not (is_fortran and (NO_CODE.match(begin) or DECLARATION.match(begin))):
            counted[number] = counted.get(number, 0) + line["count"]
    for folder in (str(path.parent), "all"):
        statements[folder] += len(counted)
        ran[folder] += sum(count > 0 for count in counted.values())
    for number in sorted(number for number, count in counted.items() if count == 0):
        print(f"{path}:{number}: {text[number - 1].strip()}")
print("\nfolder           statements   run  per cent")
for folder in sorted(statements):
    print(f"{folder:20s} {statements[folder]:6d} {ran[folder]:5d} {100 * ran[folder] / statements[folder]:8.1f}")
print(
    f"coverage: {ran['all']} of {statements['all']} statements of src and drivers, {100 * ran['all'] / statements['all']:.1f} per cent"
)
