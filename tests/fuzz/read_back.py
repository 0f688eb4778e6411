"""Results read back by the Python package: the command "read PATH", answered as by fuzz_target."""

import sys
import time
import traceback

import mfv

#: What the package says that mfv.read raises.
PROMISED = (OSError, mfv.NotAResult)

print("fuzz_target", flush=True)
for line in sys.stdin:
    path = line.removeprefix("read ").strip()
    started = time.monotonic()
    status, message = 0, ""
    try:
        mfv.read(path)
    except PROMISED as error:
        status, message = 1, str(error).splitlines()[0] if str(error) else ""
    except BaseException as error:  # what must not be raised, of whatever kind
        traceback.print_exc()
        place = traceback.extract_tb(error.__traceback__)
        own = [frame for frame in place if "/mfv/" in frame.filename] or place
        status, message = -1, f"{type(error).__name__} in {own[-1].name}, line {own[-1].lineno}: {error}".replace("\n", " ")
    print(f"{status}\t{time.monotonic() - started:.3f}\t-1\t{message}", flush=True)
