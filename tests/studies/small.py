"""Small studies to test with, and the command as a user runs it."""

import os
import subprocess
import sys
from pathlib import Path

import mfv

ROOT = Path(__file__).resolve().parents[2]
MFV_RUN = os.environ.get("MFV_RUN", str(ROOT / "build/release/bin/mfv_run"))
COMPLETE, INPUT, INTERRUPTED = 0, 2, 130

BASE = """! a small case of Mindlin's problem
&scene coupling='goodman', length_unit='mm', force_unit='N' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width=0.01225 /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.8e-4 /
&step tangential_force=-2.8e-4, cycles={cycles} /
"""
STUDY = """&sweep base='base.nml', reference='full' /
&vary key='friction%mu', values=0.3, 0.7 /
&vary key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1, from=1e-4, to=4e-4, count=3, spacing='log', name='Q' /
&vary key='scene%coupling', values='full', 'goodman', 'none' /
"""
CASES = 18

#: The same from Python.
Q = mfv.Axis(["step(2)%tangential_force", "step(3)%tangential_force"], [1e-4, 1e-4 * 4.0**0.5, 4e-4], [1, -1])
AXES = {"friction%mu": [0.3, 0.7], "Q": Q, "scene%coupling": ["full", "goodman", "none"]}


def write(folder, study=STUDY, nodes=21, cycles=1):
    """A study in a folder, and its base."""
    (folder / "base.nml").write_text(BASE.format(nodes=nodes, cycles=cycles))
    (folder / "study.nml").write_text(study)
    return folder / "base.nml"


#: A pad whose smallest force has slip zones of less than an interval, and whose others are resolved.
PAD = """&scene length_unit='mm', force_unit='N' /
&body shape='half_plane', youngs_modulus=74100, poisson_ratio=0.33 /
&body shape='disk', radius=127, youngs_modulus=74100, poisson_ratio=0.33 /
&friction law='coulomb', mu=0.65 /
&step normal_force=500, friction=.false. /
&step tangential_force=100 /
&step tangential_force=-100, cycles=1 /
"""
PAD_FORCES = mfv.Axis(Q.keys, [6.5, 50.0, 150.0], [1, -1])
PAD_STUDY = "&sweep base='pad.nml' /\n&vary key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1, values=6.5, 50, 150, name='Q' /\n"


def long_study(folder, count=60, nodes=51):
    """Cases enough to be caught at work."""
    write(
        folder,
        "&sweep base='base.nml' /\n"
        f"&vary key='friction%mu', from=0.4, to=1.0, count={count} /\n&vary key='scene%coupling', values='full', 'none' /\n",
        nodes=nodes,
        cycles=4,
    )
    return 2 * count


def environment():
    """That of a user's shell, for this package and for ranks."""
    package = str(Path(mfv.__file__).resolve().parents[1])
    open_mpi = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    return os.environ | open_mpi | {"PYTHONPATH": package}


def command(*arguments):
    """The words of `mfv study`."""
    return [sys.executable, "-m", "mfv", "study", *map(str, arguments)]


def run(*arguments, cwd, **options):
    """`mfv study` in a folder."""
    return subprocess.run(command(*arguments), cwd=cwd, capture_output=True, text=True, timeout=300, env=environment(), **options)
