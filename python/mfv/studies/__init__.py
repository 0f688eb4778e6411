"""Parameter studies: many cases that differ in some values, solved by any executor, as one xarray.Dataset.

`study` solves them; with a `Study` the cases can be listed and checked first. `regime_map` maps the regimes of a case over two of its
loads. `flagged` says which values of a table are in doubt.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .axes import Axis
from .maps import regime_map
from .plan import Study, study

if TYPE_CHECKING:
    import xarray

__all__ = ["Axis", "Study", "flagged", "regime_map", "study"]


def flagged(table: xarray.Dataset, name: str) -> xarray.DataArray:
    """For each case of a study, whether a column is in doubt; see `mfv.studies.dataset.flagged`, which needs xarray."""
    from .dataset import flagged as of_table  # here, since it imports xarray

    return of_table(table, name)
