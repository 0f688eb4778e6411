"""Keys that a study can vary: what is wrong with one, or with two of them."""

from __future__ import annotations

from .. import errors
from .._library import library, text_for
from ..scene import _scene_handle, _set_key, _text_of_scene, created
from .cases import DUNDURS_BETA, key_info

#: Keys of the materials that dundurs_beta replaces.
OF_MATERIALS = ("shear_modulus", "youngs_modulus", "poisson_ratio", "rigid")


def fault_of_key(key: str) -> str:
    """Why something is no key of a case, in the words of the library, or not for a study to set; empty where it is."""
    if key.lower() == DUNDURS_BETA:
        return ""
    if key.lower() == "output%file":
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
        if beta.lower() == DUNDURS_BETA and key.partition("%")[2].lower() in OF_MATERIALS:
            return f"'{key}' and '{DUNDURS_BETA}' cannot be varied in one study: {DUNDURS_BETA} decides the materials of both bodies"
    return f"'{other}': is varied already" if one.lower() == other.lower() or _stands_for(one, other) else ""


def _stands_for(one: str, other: str) -> bool:
    """Whether one key takes the place of another, as the library sees it."""
    if DUNDURS_BETA in (one.lower(), other.lower()) or one.partition("%")[0].lower() != other.partition("%")[0].lower():
        return False
    with _scene_handle("", "keys") as handle:
        _set_key(handle, one, 0)
        before = _text_of_scene(handle)
        library().mfv_scene_make_room(handle, text_for(other))
        return _text_of_scene(handle) != before


def numbered_group(key: str) -> tuple[str, int | None]:
    """Group of a key in small letters, and its number where it has one."""
    group, _, _ = key.lower().partition("%")
    name, bracket, number = group.partition("(")
    return name, int(number.rstrip(")")) if bracket else None
