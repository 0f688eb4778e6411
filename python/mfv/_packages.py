"""Optional Python packages."""

from __future__ import annotations

import sys

#: Packages that belong together, as the extras of pyproject.toml have them.
TOGETHER = (("plotly", "jinja2"), ("xarray", "h5netcdf", "threadpoolctl"), ("dask", "distributed"))


def how_to_install(package: str) -> str:
    """The command that installs a package and related ones for this Python."""
    packages = next((group for group in TOGETHER if package in group), (package,))
    return f'"{sys.executable}" -m pip install {" ".join(repr(name) for name in packages)}'
