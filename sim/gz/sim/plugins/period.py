"""The period of a system that publishes at a stated frequency."""

from __future__ import annotations

LONGEST_NS = 10**18
"""Thirty years: longer than any run."""


def period_ns(hertz: float) -> int:
    """Return the period [ns] of a frequency [Hz]; 0, meaning every step, for frequencies not above zero or above 1
    GHz.
    """
    return int(min(1e9 / hertz, LONGEST_NS)) if hertz > 0.0 else 0
