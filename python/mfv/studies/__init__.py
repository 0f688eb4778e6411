"""Parameter studies: many cases that differ in some values, solved by any executor, as one xarray.Dataset.

`study` solves them; with a `Study` the cases can be listed and checked first.
"""

from __future__ import annotations

from .axes import Axis
from .plan import Study, study

__all__ = ["Axis", "Study", "study"]
