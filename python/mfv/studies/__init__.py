"""Parameter studies: many cases that differ in some values, solved by any executor, as one xarray.Dataset.

`study` solves them; a `Study` can be looked at first: its cases, their texts, whether they are valid.
"""

from __future__ import annotations

from .axes import Axis
from .plan import Study, study

__all__ = ["Axis", "Study", "study"]
