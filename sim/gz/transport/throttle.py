"""A rate limit in messages per second, for publishers and subscriptions.

As in gz-transport it uses the monotonic clock of the machine, not simulated time.
"""

from __future__ import annotations

import threading
import time

from gz_course.sim.gz.transport.options import UNTHROTTLED


class Throttle:
    """Enforces at least 1 / msgs_per_sec [s] between two messages."""

    def __init__(self, msgs_per_sec: int) -> None:
        self._period_ns = 0 if msgs_per_sec == UNTHROTTLED else round(1e9 / msgs_per_sec)
        self._next_ns = 0
        self._lock = threading.Lock()

    def ready(self) -> bool:
        """Return whether a message would pass now."""
        return not self._period_ns or time.monotonic_ns() >= self._next_ns

    def passes(self) -> bool:
        """Return whether this message passes; if so, the interval starts again."""
        if not self._period_ns:
            return True
        with self._lock:
            now = time.monotonic_ns()
            if now < self._next_ns:
                return False
            self._next_ns = now + self._period_ns
            return True
