"""The period of a system that publishes at a stated frequency."""

from __future__ import annotations

LONGEST_NS = 10**18
"""The longest period [ns], about thirty years."""


def period_ns(hertz: float) -> int:
    """Return the period [ns] of a frequency [Hz].

    It is 0, which means every step, for frequencies of 0 or less and above 1 GHz.
    """
    return int(min(1e9 / hertz, LONGEST_NS)) if hertz > 0.0 else 0
