"""The time of a bag while it is played: it runs at a rate, stands still and jumps."""

from __future__ import annotations

import time


class PlaybackClock:
    """Relates the time of the bag [ns] to that of the machine. Not for several threads."""

    def __init__(self, start: int, rate: float, paused: bool) -> None:
        self._rate = rate
        self._paused = paused
        self._bag, self._machine = start, time.monotonic_ns()

    @property
    def rate(self) -> float:
        return self._rate

    @property
    def paused(self) -> bool:
        return self._paused

    def now(self) -> int:
        """Return the time of the bag [ns]."""
        if self._paused:
            return self._bag
        return self._bag + int((time.monotonic_ns() - self._machine) * self._rate)

    def until(self, bag: int) -> float:
        """Return the time [s] until a time of the bag [ns] if nothing changes; it may be negative."""
        return (bag - self._bag) / self._rate * 1e-9 - (time.monotonic_ns() - self._machine) * 1e-9

    def jump(self, bag: int) -> None:
        self._bag, self._machine = bag, time.monotonic_ns()

    def set_rate(self, rate: float) -> None:
        self.jump(self.now())
        self._rate = rate

    def set_paused(self, paused: bool) -> None:
        self.jump(self.now())
        self._paused = paused
