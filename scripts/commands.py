"""Make this Python environment import mfv from the source tree, and have its commands: python commands.py PROGRAMS.

PROGRAMS is the folder of mfv_run and the others. Standard library only.
"""

import sys
import sysconfig
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Python's path may be long or have blanks, which #! does not take: a script for sh and for Python, as pip writes them.
LAUNCHER = """\
#!/bin/sh
'''exec' "{python}" "$0" "$@"
' '''
import sys

from mfv.commands import main

if __name__ == "__main__":  # not in the processes of a study, which import this file
    sys.exit(main())
"""


def main() -> None:
    """Write the path file, the command mfv, and links to the programs."""
    programs, scripts = Path(sys.argv[1]).resolve(), Path(sysconfig.get_path("scripts"))
    Path(sysconfig.get_path("purelib"), "mfv_source_tree.pth").write_text(f"{ROOT / 'python'}\n")
    command = scripts / "mfv"
    command.write_text(LAUNCHER.format(python=sys.executable))
    command.chmod(0o755)
    for name in ("mfv_run", "mfv_stress", "mfv_conventional"):
        (scripts / name).unlink(missing_ok=True)
        (scripts / name).symlink_to(programs / name)


if __name__ == "__main__":
    main()
