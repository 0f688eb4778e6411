"""What the address, leak and undefined-behaviour sanitizers have written: findings.py <file...>, exit code 1 when it matters.

Left out are overflows of 8-byte integers (gfortran's reallocation on assignment computes with the bounds of what is not allocated;
our own numbers of that kind are times and sizes), and leaks without a frame of ours (Python and its packages, which do not tidy
up at their end; programs that are not Python fail by themselves with any leak)."""
import re
import sys
from pathlib import Path

OURS = re.compile(r"/libmfv|/mfv_\w+\+|/test_\w+\+| in (mfv_|__mfv_)")
BOUNDS = re.compile(r"runtime error: signed integer overflow: .* in type 'integer\(kind=8\)'")


def matters(block):
    if "runtime error:" in block:
        return not BOUNDS.search(block)
    if re.match(r"(Direct|Indirect) leak", block):
        return bool(OURS.search(block))
    return "ERROR: AddressSanitizer" in block or "AddressSanitizer: CHECK failed" in block


blocks = []
for path in map(Path, sys.argv[1:]):
    text = path.read_text(errors="replace")
    blocks += [block.strip() for block in re.split(r"\n\s*\n|\n(?=\S+:\d+:\d+: runtime error)", text) if block.strip()]
wrong = sorted({block for block in blocks if matters(block)})
print("\n\n".join(wrong[:20]))
print(f"{len(sys.argv) - 1} reports, {len(wrong)} findings that matter")
sys.exit(bool(wrong))
