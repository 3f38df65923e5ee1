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
