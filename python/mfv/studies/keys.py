"""Keys that a study can vary, in small letters: what is wrong with one, or with two of them."""

from __future__ import annotations

from .. import errors
from .._library import library, text_for
from ..scene import _scene_handle, _set_key, _text_of_scene, created
from .cases import DUNDURS_BETA, key_info

#: Keys of the materials that dundurs_beta replaces.
OF_MATERIALS = ("shear_modulus", "youngs_modulus", "poisson_ratio", "rigid")


def fault_of_key(key: str) -> str:
    """Why something is no key of a case, in the words of the library, or not for a study to set; empty where it is."""
    if key == DUNDURS_BETA:
        return ""
    if key == "output%file":
        return "'output%file': the study names its files itself"
    if key_info(key) is None:
        with _scene_handle("", "key") as handle:
            _set_key(handle, key, 0)
            try:
                created("mfv_create", handle)
            except errors.InputError as error:
                told = error.message.removeprefix("key: ")
                return told if "%" in key else f"{told} or '{DUNDURS_BETA}'"
    return ""


def fault_of_pair(one: str, other: str) -> str:
    """Why a study cannot vary two keys; empty where it can."""
    for beta, key in ((one, other), (other, one)):
        if beta == DUNDURS_BETA and key.partition("%")[2] in OF_MATERIALS:
            return f"'{key}' and '{DUNDURS_BETA}' cannot be varied in one study: {DUNDURS_BETA} decides the materials of both bodies"
    return f"'{other}': is varied already" if one == other or _stands_for(one, other) else ""


def _stands_for(one: str, other: str) -> bool:
    """Whether one key takes the place of another, as the library sees it."""
    if DUNDURS_BETA in (one, other) or one.partition("%")[0] != other.partition("%")[0]:
        return False
    with _scene_handle("", "keys") as handle:
        _set_key(handle, one, 0)
        before = _text_of_scene(handle)
        library().mfv_scene_make_room(handle, text_for(other))
        return _text_of_scene(handle) != before


def numbered_group(key: str) -> tuple[str, int | None]:
    """Group of a key, and its number where it has one."""
    group, _, _ = key.partition("%")
    name, bracket, number = group.partition("(")
    return name, int(number.rstrip(")")) if bracket else None
