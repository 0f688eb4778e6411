"""The package under test: an installed one, else that of the source tree."""

import importlib.util
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # the package truth
if importlib.util.find_spec("mfv") is None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
