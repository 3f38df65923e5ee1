"""Number types for options; argparse turns their ValueError into a usage error with exit code 2."""

from __future__ import annotations

import math


def seconds(text: str) -> float:
    """Parse a finite time [s], at least 0. Raises ValueError."""
    value = float(text)
    if not 0.0 <= value < math.inf:
        raise ValueError
    return value


def rate(text: str) -> float:
    """Parse a finite rate [Hz] above 0. Raises ValueError."""
    value = float(text)
    if not 0.0 < value < math.inf:
        raise ValueError
    return value


def whole_number(text: str) -> int:
    """Parse an integer, at least 0. Raises ValueError."""
    value = int(text)
    if value < 0:
        raise ValueError
    return value


def positive_number(text: str) -> int:
    """Parse an integer, at least 1. Raises ValueError."""
    value = int(text)
    if value < 1:
        raise ValueError
    return value


def time_to_live(text: str) -> int:
    """Parse the number of networks that a packet may cross, 1 to 255. Raises ValueError."""
    value = int(text)
    if not 1 <= value <= 255:
        raise ValueError
    return value
