"""Programs on a disk that fails, or that are killed while they write: tests/cli/fault.c preloaded."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run")).parent
RUN, STRESS, CONVENTIONAL = (str(BUILD / name) for name in ("mfv_run", "mfv_stress", "mfv_conventional"))

CASE = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=21, half_width=0.0127 /
&friction law='coulomb', mu={mu} /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.0e-4 /
&output file='case.h5' /
"""


def build_shim(folder):
    """Compile fault.c into a folder; the path of the library."""
    library = folder / "fault.so"
    source = Path(__file__).with_name("fault.c")
    subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", "-o", library, source, "-ldl", "-lpthread"], check=True)
    return library


def run(command, folder, **options):
    """A program in a folder, with its output; `options`: of subprocess.run."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(ROOT / "python")}
    options["env"] = {**environment, **options.get("env", {})}
    return subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, timeout=300, **options)


def run_on_disk(shim, command, folder, call, number=0):
    """The program with a `call` that fails with errno `number`, or is a kill where that is 0; see fault.c. The optimised mfv_run
    has its C library inside (MfvArchives): calls can fail in other builds only."""
    if subprocess.run(["ldd", command[0]], capture_output=True, check=False).returncode != 0:
        pytest.skip("a static program: see the debug preset")
    return run(command, folder, env={"LD_PRELOAD": str(shim), "MFV_FAULT_CALL": call, "MFV_FAULT_ERRNO": str(number)})


def go_on_with(process, number):
    """Send a signal to a process that has been stopped, and let it go on; what it printed and said."""
    process.send_signal(number)
    process.send_signal(signal.SIGCONT)
    return process.communicate(timeout=300)


def wait_for_work(process, seconds):
    """Wait until a process has used `seconds` of processor time, however busy the machine is, or has ended."""
    ticks = os.sysconf("SC_CLK_TCK")
    while process.poll() is None:
        words = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        if (int(words[11]) + int(words[12])) / ticks >= seconds:
            return
        time.sleep(0.005)


def parts(folder):
    """Files that were being written, in a folder and those below it."""
    return sorted(path for path in folder.rglob("*.part[0-9]*"))
