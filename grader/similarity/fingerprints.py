"""Fingerprints of a text: hashes of all runs of `RUN` tokens, of which winnowing selects few.

Two texts that share `RUN + WINDOW - 1` tokens in a row share a selected fingerprint. Runs of given code are left out.

Source: S. Schleimer, D. Wilkerson, A. Aiken, "Winnowing: Local Algorithms for Document Fingerprinting", SIGMOD 2003.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from gz_course.grader.similarity.tokens import Text

RUN, WINDOW = 14, 8
BASE = np.uint64(0x9E3779B97F4A7C15)  # odd, with bits of all weights; products wrap at 2**64

Hashes = NDArray[np.uint64]


def runs(text: Text) -> Hashes:
    """Return the hash of the run that begins at each token; runs do not go from one file into the next."""
    count = len(text.symbols) - RUN + 1
    if count <= 0:
        return np.zeros(0, np.uint64)
    hashes = np.zeros(count, np.uint64)
    with np.errstate(over="ignore"):
        for place in range(RUN):
            hashes = hashes * BASE + text.symbols[place : place + count] * np.uint64(0xFF51AFD7ED558CCD)
            hashes ^= hashes >> np.uint64(29)
    hashes[text.files[:count] != text.files[RUN - 1 :]] = 0
    return hashes


def own_runs(hashes: Hashes, given: Hashes) -> NDArray[np.intp]:
    """Return where runs begin that are not in given code (sorted hashes)."""
    return np.flatnonzero((hashes != 0) & ~np.isin(hashes, given))


def winnowed(hashes: Hashes, most: int) -> Hashes:
    """Return the selected hashes, each once, at most `most`."""
    if len(hashes) > WINDOW:
        windows = sliding_window_view(hashes, WINDOW)
        hashes = windows[np.arange(len(windows)), np.argmin(windows, axis=1)]
    return np.unique(hashes)[:most]
