"""The end of an error sentence about an unknown name: the most similar known name."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import SequenceMatcher, get_close_matches
from functools import lru_cache

_LONGEST = 200  # compared characters; bounded, because names come from untrusted files and networks
_MOST = 5000  # compared names
_LISTED = 12


def nearest_name(name: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the known name that is most similar to `name`, ignoring case; empty if none is similar enough.

    The name itself is never returned. `cutoff` is the minimum similarity, from 0 to 1.
    """
    originals: dict[str, str] = {}
    for each in sorted(set(known) - {name})[:_MOST]:
        originals.setdefault(each[:_LONGEST].lower(), each)
    close = get_close_matches(name[:_LONGEST].lower(), originals, n=1, cutoff=cutoff)
    return originals[close[0]] if close else ""


def most_similar(name: str, known: Iterable[str], most: int) -> list[str]:
    """Return at most so many known names, the most similar to `name` first. The name itself is never returned."""
    others = [each for each in dict.fromkeys(known) if each != name][:_MOST]
    return sorted(others, key=lambda each: -_likeness(name[:_LONGEST], each[:_LONGEST]))[:most]


@lru_cache(4096)
def _likeness(name: str, other: str) -> float:
    return SequenceMatcher(None, name, other).ratio()


def did_you_mean(name: str, known: Iterable[str], *, listing: str = "", cutoff: float = 0.6) -> str:
    """Return the end of a sentence: `; did you mean 'x'?` with the known name that is most similar to `name`.

    If no known name is similar it is `; its links are: a, b, ...` for the `listing` `its links are`, else an empty
    text.
    """
    names = sorted(set(known) - {name})
    if near := nearest_name(name, names, cutoff):
        return f"; did you mean '{near}'?"
    if not (listing and names):
        return ""
    return f"; {listing}: {', '.join(names[:_LISTED])}{', ...' if len(names) > _LISTED else ''}"
