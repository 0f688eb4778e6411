"""Measured profiles: line scans and lines of areal maps, from texts and, by SurfaceTopography, from files of instruments.

`read` gives positions and recess in the unit of the scene, for `Body.profile`; `mfv profile` writes them as a text for `&body file`.
"""

from __future__ import annotations

import os
import warnings
from numbers import Real
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import tables
from ._packages import needed
from .errors import MfvError, input_error

Array = NDArray[np.float64]

#: Formats that SurfaceTopography recognises by the size of the file alone, which may be that of anything.
_GUESSES = {"hgt": ".hgt", "nms": ".nms"}


class Reading(TypedDict, total=False):
    """Options of `read`."""

    unit: str
    file_unit: str | None
    outwards: bool | None
    spacing: float | None
    line: int | Literal["middle", "mean"] | None
    along: Literal["x", "y"] | None
    channel: int | str | None
    lambda_s: float | None
    lambda_c: float | None


class Profile(NamedTuple):
    """Positions and the recess there, NaN without a value, in a unit of length; notes for the user."""

    x: Array
    height: Array
    unit: str
    notes: list[str]


def read(
    path: str | os.PathLike[str],
    *,
    unit: str = "mm",
    file_unit: str | None = None,
    outwards: bool | None = None,
    spacing: float | None = None,
    line: int | Literal["middle", "mean"] | None = None,
    along: Literal["x", "y"] | None = None,
    channel: int | str | None = None,
    lambda_s: float | None = None,
    lambda_c: float | None = None,
) -> Profile:
    """A profile from a text file (`tables.read_trace`), or by SurfaceTopography from that of an instrument.

    `unit`: of the positions and heights that are returned, and of `spacing`, `lambda_s` and `lambda_c`. `file_unit`: that of a file
    which names none; if omitted: `unit`, with a note. `outwards`: whether heights of the file are positive out of the material, as
    those of instruments are; they are returned as the recess, with the other sign. If omitted: unless the heading of a text says that
    they are the recess, as that of `mfv profile` does. `spacing`: of heights without positions. Areal
    maps: `along` x (if omitted) or y, `line` counts lines from 1 across it; 'mean': the mean of all lines; if omitted: 'middle'.
    `channel`: number from 1 or name; if omitted: the default of the format. Gaussian filters of ISO 16610-21: waves shorter than
    `lambda_s` and longer than `lambda_c` are removed (half of the amplitude at that wavelength); positions that are not at equal
    distances are interpolated first. The filters need scipy, files of instruments SurfaceTopography. Raises
    OSError, InputError, ModuleNotFoundError.
    """
    name = os.fspath(path)
    tables.factor(unit, "m")
    notes: list[str] = []
    if isinstance(line, bool) or not (line in (None, "middle", "mean") or (isinstance(line, int) and line >= 1)):
        raise input_error(f"line: must be 'middle', 'mean' or a number from 1, not {line!r}")
    if along not in (None, "x", "y"):
        raise input_error(f"along: must be 'x' or 'y', not {along!r}")
    for key, length in (("spacing", spacing), ("lambda_s", lambda_s), ("lambda_c", lambda_c)):
        if length is not None and not (isinstance(length, Real) and 0.0 < length < np.inf):
            raise input_error(f"{key}: must be a positive length in {unit}, not {length!r}")
    if lambda_s is not None and lambda_c is not None and lambda_s >= lambda_c:
        raise input_error(f"lambda_s={lambda_s}: must be below lambda_c={lambda_c}, or no wave is left")
    try:
        tables.check_text(path)
        x, height, x_unit, height_unit, is_recess = tables.read_trace(path, heights_alone=spacing is not None)
    except tables.Ambiguous as fault:
        raise input_error(f"{fault}; or give spacing in {unit} for heights") from None
    except tables.Unordered as fault:
        raise input_error(str(fault)) from None
    except MfvError as fault:
        x, height, x_unit = _of_instrument(path, fault, line, along, channel, notes)
        height_unit, is_recess = x_unit, False
    else:
        _refuse(name, "a text with one profile", line=line, along=along, channel=channel)
    x_scale, height_scale = _scales(name, unit, file_unit, x_unit, height_unit, notes)
    if outwards is None:
        outwards = not is_recess
        if outwards and not (x_unit or height_unit or file_unit):
            notes.append(
                f"{name}: heights are taken as positive out of the material; outwards=False (--inwards) if they are the recess"
            )
    height = height_scale * height
    if x is None and spacing is None:
        raise input_error(f"{name}: has no distances between its heights; give spacing in {unit}")
    if x is not None and spacing is not None:
        raise input_error(f"{name}: has positions; remove spacing")
    place: Array = np.asarray(np.arange(height.size) * float(spacing or 0.0) if x is None else x_scale * x)
    has_place = np.isfinite(place)
    if not has_place.all():
        notes.append(f"{name}: {np.sum(~has_place)} of {place.size} points have no position and are omitted")
        place, height = place[has_place], height[has_place]
    if not np.any(np.isfinite(height)):
        raise input_error(f"{name}: no height has a value")
    if not np.nanmin(place) < np.nanmax(place):
        raise input_error(f"{name}: a profile needs at least two points at different positions")
    if lambda_s is not None or lambda_c is not None:
        if place.size < 3:
            raise input_error(f"{name}: a filter needs at least 3 points; it has {place.size}")
        place, height = _filtered(place, height, lambda_s, lambda_c, notes)
    return Profile(place, -height if outwards else height, unit, notes)


def _refuse(name: str, what: str, **options: Any) -> None:
    """Raises InputError for options that have no effect on a file."""
    given = [option for option, value in options.items() if value is not None]
    if given:
        raise input_error(f"{name}: is {what}, for which {', '.join(given)} would have no effect: remove {', '.join(given)}")


def _scales(name: str, unit: str, given: str | None, x_unit: str, height_unit: str, notes: list[str]) -> tuple[float, float]:
    """Factors of positions and heights. Raises InputError."""
    named = [found for found in (x_unit, height_unit) if found]
    usual = given or (named[0] if named else unit)
    if len(named) == 2 and given:
        raise input_error(f"{name}: is in {' and '.join(dict.fromkeys(named))}; remove file_unit")
    if not named and not given:
        notes.append(f"{name} names no unit of length: its numbers are taken as {unit}; file_unit chooses another")
    elif len(named) == 1 and not given:
        notes.append(f"{name} names one unit of length, {usual}: it is taken for positions and heights")
    return tables.factor(x_unit or usual, unit), tables.factor(height_unit or usual, unit)


def _of_instrument(
    path: str | os.PathLike[str],
    fault: MfvError,
    line: int | str | None,
    along: str | None,
    channel: int | str | None,
    notes: list[str],
) -> tuple[Array | None, Array, str]:
    """Positions, heights and unit of a line of a file that is not a text with columns, because of a `fault`. Raises InputError."""
    name = os.fspath(path)
    try:
        library = needed("SurfaceTopography.IO")
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(f"{fault}; for files of instruments {error}", name=error.name) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = library.open_topography(name)
            guess = _GUESSES.get(reader.format(), "")
            if guess and Path(name).suffix.lower() != guess:
                raise library.CannotDetectFileFormat("")
            number = _channel(name, reader, channel)
            info = reader.channels[number]
            sizes = None if info.physical_sizes is not None else tuple(float(n) for n in info.nb_grid_pts)
            map_ = reader.topography(channel_index=number, **({} if sizes is None else {"physical_sizes": sizes}))
            heights: Array = np.ma.filled(np.ma.asarray(map_.heights(), dtype=float), np.nan)
            positions = None if sizes is not None else map_.positions()
        except MfvError:
            raise
        except library.CannotDetectFileFormat:
            raise input_error(f"{fault}, nor a format that SurfaceTopography knows{_reason(library, name)}") from None
        except Exception as error:  # readers raise exceptions of many types
            raise input_error(f"{name}: SurfaceTopography cannot read it: {_sentence(error)}") from None
    unit = tables.unit_of(str(info.unit)) if info.unit else ""
    if info.unit and not unit:
        raise input_error(f"{name}: heights in {info.unit}, which is not a length; choose another channel: {_channels(reader)}")
    if heights.ndim == 1:
        _refuse(name, "one line, not a map", line=line, along=along)
        return None if positions is None else np.asarray(positions, dtype=float), heights, unit
    line, along = line or "middle", along or "x"
    if along == "y":
        heights = heights.T
    size = None if positions is None else np.asarray(positions[0][:, 0] if along == "x" else positions[1][0, :], dtype=float)
    count = heights.shape[1]
    if line == "mean":
        counted = np.sum(np.isfinite(heights), axis=1)
        height = np.where(counted > 0, np.nansum(heights, axis=1) / np.maximum(counted, 1), np.nan)
        notes.append(f"{name}: mean of {count} lines along {along}")
    else:
        chosen = (count + 1) // 2 if line == "middle" else int(line)
        if chosen > count:
            raise input_error(f"{name}: line {chosen}: the map has {count} lines along {along}")
        height = heights[:, chosen - 1]
        notes.append(f"{name}: line {chosen} of {count} along {along}")
    return size, height, unit


def _channels(reader: Any) -> str:
    return ", ".join(str(info.name) for info in reader.channels)


def _channel(name: str, reader: Any, channel: int | str | None) -> int:
    """The number from 0 of a channel by its number from 1 or its name. Raises InputError."""
    if channel is None:
        return int(reader.default_channel.index)
    names = [str(info.name) for info in reader.channels]
    if str(channel) in names:
        return names.index(str(channel))
    if str(channel).isdigit() and 1 <= int(channel) <= len(names):
        return int(channel) - 1
    raise input_error(f"{name}: no channel {channel!r}; there are {', '.join(names)}")


def _reason(library: Any, name: str) -> str:
    """Why the reader that the suffix of a file calls for cannot read it; empty if no reader has this suffix."""
    suffix = Path(name).suffix.lower().lstrip(".")
    for kind in library.readers:
        if suffix and suffix != "txt" and suffix in [kind.format(), *(getattr(kind, "_file_extensions", None) or [])]:
            try:
                kind(name)
            except Exception as error:
                return f" (its reader of .{suffix}: {_sentence(error)})"
    return ""


def _sentence(error: Exception) -> str:
    """The first line of the message of an exception, without what cannot be printed; with its type if it says little."""
    lines = [text for text in str(error).splitlines() if text.strip()] or [""]
    text = "".join(character if character.isprintable() else "?" for character in lines[0]).strip()[:160]
    says_little = isinstance(error, (LookupError, TypeError, AttributeError)) or len(text.split()) < 5
    return text if not says_little else f"damaged, or of an unknown variant ({type(error).__name__}: {text})"


def _filtered(x: Array, height: Array, lambda_s: float | None, lambda_c: float | None, notes: list[str]) -> tuple[Array, Array]:
    """Heights without waves shorter than `lambda_s` and longer than `lambda_c`, at equal distances."""
    if x[0] > x[-1]:
        x, height = x[::-1], height[::-1]
    steps = np.diff(x)
    if np.ptp(steps) > 1e-3 * np.mean(steps):
        valued = np.isfinite(height)
        equal = np.linspace(x[0], x[-1], x.size)
        x, height = equal, np.interp(equal, x[valued], height[valued])
        notes.append(f"interpolated to equal distances of {x[1] - x[0]:.4g} for the filter")
    step = float(x[1] - x[0])
    if lambda_s is not None:
        height = _waviness(height, lambda_s / step)
    if lambda_c is not None:
        height = height - _waviness(height, lambda_c / step)
    return x, height


def _waviness(height: Array, cutoff: float) -> Array:
    """The mean line of the Gaussian filter of ISO 16610-21, `cutoff` in points: weights exp(-pi (x/(alpha cutoff))^2), alpha =
    sqrt(ln 2/pi). Near the ends and gaps the weights of existing points are normalised (ISO 16610-28)."""
    smooth = needed("scipy.ndimage").gaussian_filter1d
    sigma = np.sqrt(np.log(2.0)) / (np.pi * np.sqrt(2.0)) * cutoff
    valued = np.isfinite(height)
    options = {"sigma": sigma, "mode": "constant", "truncate": 6.0}
    weights = smooth(valued.astype(float), **options)
    mean = smooth(np.where(valued, height, 0.0), **options) / np.where(weights > 0.0, weights, 1.0)
    return np.where(valued, mean, np.nan)
