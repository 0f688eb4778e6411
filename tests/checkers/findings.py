"""What the address and leak sanitizers have written: findings.py <file...>, exit code 1 when it matters.

Left out are leaks without a frame of ours (Python and its packages, which do not tidy up at their end). What the sanitizer of
undefined behaviour finds ends its program with a message on standard error: the test of it fails."""

import re
import sys
from pathlib import Path

OURS = re.compile(r"/libmfv|/mfv_\w+\+|/test_\w+\+| in (mfv_|__mfv_)")


def matters(block):
    if re.match(r"(Direct|Indirect) leak", block):
        return bool(OURS.search(block))
    return "ERROR: AddressSanitizer" in block or "AddressSanitizer: CHECK failed" in block


blocks = []
for path in map(Path, sys.argv[1:]):
    text = path.read_text(errors="replace")
    blocks += [block.strip() for block in re.split(r"\n\s*\n", text) if block.strip()]
wrong = sorted({block for block in blocks if matters(block)})
print("\n\n".join(wrong[:20]))
print(f"{len(sys.argv) - 1} reports, {len(wrong)} findings that matter")
sys.exit(bool(wrong))
