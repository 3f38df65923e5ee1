"""What else a number or a text could be, the likeliest first."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from gz_course.grader.edits.edit import Vocabulary
from gz_course.sim.did_you_mean import most_similar

MOST = 12  # other values of one number
MOST_NAMES = 4  # other values of one text
# Degrees and radians, km/h and m/s, milliseconds, nanoseconds, halves and doubles.
FACTORS = (math.pi / 180, 180 / math.pi, 1 / 3.6, 3.6, 0.5, 2.0, 10.0, 0.1, 1e-3, 1e3, 1e-9, 1e9)
DIGITS = 6


def other_numbers(value: float, vocabulary: Vocabulary) -> list[str]:
    """Return what else a number could be, as texts."""
    found: list[str] = []
    for each in _candidates(value, vocabulary):
        if not math.isfinite(each) or abs(each) > 1e12:
            continue
        whole = isinstance(value, int) and each == int(each)
        text = repr(int(each)) if whole else repr(float(f"{each:.{DIGITS}g}"))
        if text not in found and float(text) != value:
            found.append(text)
    return found[:MOST]


def _candidates(value: float, vocabulary: Vocabulary) -> Iterator[float]:
    yield from (value * ratio for ratio in vocabulary.ratios)
    yield -value
    yield from vocabulary.numbers[:6]
    if isinstance(value, int):
        yield from (value + 1, value - 1)
    yield from (value * factor for factor in FACTORS) if value else (1.0,)
    yield 0
    yield from vocabulary.numbers[6:]


def nearest(text: str, known: Iterable[str]) -> list[str]:
    """Return the most similar of the known texts, without the text itself."""
    return most_similar(text, known, MOST_NAMES)
