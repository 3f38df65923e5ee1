"""The hint at the end of a sentence about a name that does not exist: the known name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

_LONGEST = 200  # characters that are compared: names come from files and networks of anybody
_MOST = 5000  # names that are compared
_LISTED = 12


def nearest_name(name: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the known name that is most like `name`, letter case ignored; empty if none is.

    `cutoff` says how much alike, from 0 to 1.
    """
    originals: dict[str, str] = {}
    for each in sorted(set(known))[:_MOST]:
        originals.setdefault(each[:_LONGEST].lower(), each)
    close = get_close_matches(name[:_LONGEST].lower(), originals, n=1, cutoff=cutoff)
    return originals[close[0]] if close else ""


def did_you_mean(name: str, known: Iterable[str], *, listing: str = "", cutoff: float = 0.6) -> str:
    """Return the end of a sentence: `; did you mean 'x'?`, or nothing if no known name is like `name`.

    With `listing`, such as `its links are`, it then lists the known names: `; its links are: a, b, ...`.
    """
    names = sorted(set(known))
    if near := nearest_name(name, names, cutoff):
        return f"; did you mean '{near}'?"
    if not (listing and names):
        return ""
    return f"; {listing}: {', '.join(names[:_LISTED])}{', ...' if len(names) > _LISTED else ''}"
