# PYTHON_ARGCOMPLETE_OK
"""The command line: mfv COMMAND, or python -m mfv COMMAND."""

import sys

from .commands import main

if __name__ == "__main__":
    sys.exit(main())
