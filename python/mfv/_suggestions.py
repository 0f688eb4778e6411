"""Proposals for misspelled words."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

#: The command that lists the columns of a table.
LISTED_BY = "'mfv info'"
#: More known words than these are not all listed.
MOST = 24


def suggestion(word: str, known: Iterable[str], before: str = "", listed_by: str = "") -> str:
    """The end of a message about an unknown word: the nearest known one, after `before`, as a question, else the known words.

    Of many words only a few, and `listed_by`, a command that lists all.
    """
    words = list(known)
    near = difflib.get_close_matches(word, words, n=1)
    if near:
        return f"; did you mean {before}{near[0]}?" + (f" {listed_by} lists all" if listed_by else "")
    return f"; choose from {some(words)}" + (f", which {listed_by} lists" if listed_by and len(words) > MOST else "")


def some(words: Sequence[str]) -> str:
    """The words, or the first few of many and how many others there are."""
    few = 5
    return ", ".join(words) if len(words) <= MOST else f"{', '.join(words[:few])} and {len(words) - few} others"
