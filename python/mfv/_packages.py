"""Python packages that this one needs."""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

#: Packages without which this one cannot be imported.
REQUIRED = ("numpy", "h5py", "f90nml")

#: Packages that belong together, as the extras of pyproject.toml have them.
TOGETHER = (
    (*REQUIRED, "matplotlib", "tqdm"),
    ("plotly", "jinja2"),
    ("xarray", "h5netcdf", "threadpoolctl"),
    ("dask", "distributed"),
    ("scipy",),
    ("scipy", "emcee"),
    ("scipy", "pylife"),
    ("SurfaceTopography", "scipy"),
    ("meshio", "netCDF4"),
)


def how_to_install(package: str) -> str:
    """The command that installs a package and related ones for this Python."""
    packages = next((group for group in TOGETHER if package in group), (package,))
    return f'"{sys.executable}" -m pip install {" ".join(repr(name) for name in packages)}'


def require(*packages: str) -> None:
    """Raises ModuleNotFoundError with the command that installs it for the first of some optional packages that is missing."""
    for package in packages:
        if find_spec(package) is None:
            raise ModuleNotFoundError(f"the Python package {package} is not installed: {how_to_install(package)}", name=package)


def needed(module: str) -> ModuleType:
    """A module of an optional package, imported on first use. Raises ModuleNotFoundError with the command that installs it."""
    require(module.split(".")[0])
    return import_module(module)


def check_required() -> None:
    """Raises ModuleNotFoundError if this Python does not have the required packages; the command line exits with a message instead."""
    missing = [name for name in REQUIRED if find_spec(name) is None]
    if not missing:
        return
    environment = Path(__file__).resolve().parents[2] / "build/venv/bin/python"
    advice = f"use {environment}" if environment.is_file() else how_to_install(missing[0])
    message = f"{sys.executable} does not have the Python packages {', '.join(missing)}: {advice}"
    if sys.argv[0] == "-m" or Path(sys.argv[0]).name == "mfv":  # python -m mfv, or its launcher
        print(f"mfv: {message}", file=sys.stderr)
        sys.exit(2)
    raise ModuleNotFoundError(message, name=missing[0])
