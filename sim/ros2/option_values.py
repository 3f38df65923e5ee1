"""Numbers as options take them; the ValueError of each becomes argparse's usage error with exit code 2."""

from __future__ import annotations

import math


def seconds(text: str) -> float:
    """A number of seconds from 0 on, and finite; ValueError otherwise."""
    value = float(text)
    if not 0.0 <= value < math.inf:
        raise ValueError
    return value


def rate(text: str) -> float:
    """A number of times a second, above 0 and finite; ValueError otherwise."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise ValueError
    return value


def whole_number(text: str) -> int:
    """A number from 0 on; ValueError otherwise."""
    value = int(text)
    if value < 0:
        raise ValueError
    return value


def positive_number(text: str) -> int:
    """A number from 1 on; ValueError otherwise."""
    value = int(text)
    if value < 1:
        raise ValueError
    return value
