"""Lines that no test has run, and a table of lines run by folder, from gcovr's JSON: coverage_by_folder.py <lines.json>."""
import json
import sys
from collections import defaultdict
from pathlib import Path

ran, lines = defaultdict(int), defaultdict(int)
for file in json.loads(Path(sys.argv[1]).read_text())["files"]:
    path = Path(file["file"])
    text = path.read_text().splitlines()
    counted = {}
    for line in file["lines"]:  # instances of one line, as in a generic procedure, count as one
        # What the compiler makes of types, copies and finalisation, is booked on the ends of procedures and modules.
        if text[line["line_number"] - 1].strip().startswith(("end function", "end subroutine", "end module")):
            continue
        counted[line["line_number"]] = counted.get(line["line_number"], 0) + line["count"]
    for folder in (str(path.parent), "all"):
        lines[folder] += len(counted)
        ran[folder] += sum(count > 0 for count in counted.values())
    for number in sorted(number for number, count in counted.items() if count == 0):
        print(f"{path}:{number}: {text[number - 1].strip()}")
print("\nfolder                lines   run  per cent")
for folder in sorted(lines):
    print(f"{folder:20s} {lines[folder]:6d} {ran[folder]:5d} {100 * ran[folder] / lines[folder]:8.1f}")
print(f"coverage: {ran['all']} of {lines['all']} lines of src and drivers, {100 * ran['all'] / lines['all']:.1f} per cent")
