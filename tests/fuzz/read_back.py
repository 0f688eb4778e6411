"""Results and tables read back by the Python package: the commands "read PATH" and "read_table PATH", answered as by fuzz_target."""

import sys
import time
import traceback

import mfv

READERS = {"read": mfv.read, "read_table": mfv.read_table}
#: What the package says that its readers raise.
PROMISED = (OSError, mfv.NotAResult)

print("fuzz_target", flush=True)
for line in sys.stdin:
    target, path = line.split(maxsplit=1)
    started = time.monotonic()
    status, message = 0, ""
    try:
        READERS[target](path.strip())
    except PROMISED as error:
        status, message = 1, str(error).splitlines()[0] if str(error) else ""
    except BaseException as error:  # what must not be raised, of whatever kind
        traceback.print_exc()
        place = traceback.extract_tb(error.__traceback__)
        own = [frame for frame in place if "/mfv/" in frame.filename] or place
        status, message = -1, f"{type(error).__name__} in {own[-1].name}, line {own[-1].lineno}: {error}".replace("\n", " ")
    print(f"{status}\t{time.monotonic() - started:.3f}\t-1\t{message}", flush=True)
