"""Parameter studies: many cases that differ in some values, solved by any executor, as one xarray.Dataset.

`study` solves them; with a `Study` the cases can be listed and checked first. `regime_map` maps the regimes of a case over two of its
loads. `flagged` says which values of a table are in doubt, `mean_over` averages realisations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .axes import Axis
from .maps import regime_map
from .plan import Study, study

if TYPE_CHECKING:
    import xarray

__all__ = ["Axis", "Study", "flagged", "mean_over", "regime_map", "study"]


def flagged(table: xarray.Dataset, name: str) -> xarray.DataArray:
    """For each case of a study, whether a column is in doubt; see `mfv.studies.dataset.flagged`, which needs xarray."""
    from .dataset import flagged as of_table  # here, since it imports xarray

    return of_table(table, name)


def mean_over(table: xarray.Dataset, axis: str, confidence: float = 0.95) -> xarray.Dataset:
    """The table of the means of all observables over one axis of a study, such as the seeds of random surfaces.

    It has the other axes; `NAME_error` is half of the confidence interval of the mean by Student's t, as for independent realisations
    (NaN for fewer than two; errors of the meshes are not in it), `realisations` the number of complete cases. Cases in which an
    observable is undefined do not count in its mean; it is named in `unresolved` then, and if it is in doubt in any case (`flagged`).
    `mfv.studies.figure` draws it. Raises InputError, ValueError for an axis that is not there or varies together with another one.
    """
    from .ensemble import mean_over as of_table  # here, since it imports xarray

    return of_table(table, axis, confidence)
