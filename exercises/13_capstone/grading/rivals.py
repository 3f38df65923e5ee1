"""Which of several mistakes with poses or angles explains the walls of a map best: more maps decide between them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.score.floor import grown

FITS, BACK = 0.8, 0.6  # of the occupied cells, to fit a mistake; of what it would draw, that is occupied
CLEARER = 0.2  # by which a mistake explains more than the scans as they are
CLOSE = 0.97  # of what the best explains; another one that explains as much may be it
MOST = 6  # maps that are looked at


def best(maps: Iterator[Any] | list[Any]) -> str:
    """Return the mistake that explains the first map with walls; later ones decide if several do.

    `maps` yields the occupied cells, the cells that were hit, and each mistake with the cells that it would draw. The
    first map holds few scans, so that the walls of different scans do not cover each other yet.
    """
    sums = {}
    for number, (marked, hit, mistakes) in enumerate(maps):
        shares = {words: fit(marked, drawn) for words, drawn in mistakes if not number or words in sums}
        if not number:
            least = max(FITS, grown(hit)[marked].mean() + CLEARER)
            sums = {words: share * back for words, (share, back) in shares.items() if share >= least and back >= BACK}
        else:
            sums = {words: known + float(np.prod(shares[words])) for words, known in sums.items()}
        if len(sums) < 2 or number >= MOST:
            break
    first, *others = sorted(sums, key=lambda words: -sums[words]) or [""]
    if others and sums[others[0]] > CLOSE * sums[first]:
        return f"one of two mistakes: {first}; or {others[0]}"
    return first


def fit(marked: np.ndarray, drawn: np.ndarray) -> tuple[float, float]:
    """Return how much of the occupied cells a mistake explains, and how much of what it draws is occupied."""
    return grown(drawn)[marked].mean(), grown(marked)[drawn].mean() if drawn.any() else 0.0
