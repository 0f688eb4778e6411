"""Proposals for misspelled words."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def suggestion(word: str, known: Iterable[str], before: str = "") -> str:
    """The end of a message about an unknown word: the nearest known one, after `before`, as a question, else all of them."""
    words = list(known)
    near = difflib.get_close_matches(word, words, n=1)
    return f"; did you mean {before}{near[0]}?" if near else f"; choose from {', '.join(words)}"
