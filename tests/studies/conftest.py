"""The package under test: an installed one, else that of the source tree."""

import importlib.util
import sys
from pathlib import Path

import pytest

if importlib.util.find_spec("mfv") is None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    """The folder of the small study, and its dataset, solved by one thread."""
    import small

    import mfv

    folder = tmp_path_factory.mktemp("study")
    base = small.write(folder)
    return folder, mfv.study(base, small.AXES, reference="full", workers=1)
