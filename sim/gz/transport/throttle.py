"""A rate limit in messages per second.

It sits before sending in a publisher and before the callback in a subscription. Measured on the monotonic clock
of the machine, as in gz-transport; simulated time plays no part.
"""

from __future__ import annotations

import threading
import time

from gz_course.sim.gz.transport.options import UNTHROTTLED


class Throttle:
    """At least 1 / msgs_per_sec seconds between two messages that pass."""

    def __init__(self, msgs_per_sec: int) -> None:
        self._period_ns = 0 if msgs_per_sec == UNTHROTTLED else round(1e9 / msgs_per_sec)
        self._next_ns = 0
        self._lock = threading.Lock()

    def ready(self) -> bool:
        """Return whether a message would pass now."""
        return not self._period_ns or time.monotonic_ns() >= self._next_ns

    def passes(self) -> bool:
        """Return whether this message passes; if it does, the waiting time starts anew."""
        if not self._period_ns:
            return True
        with self._lock:
            now = time.monotonic_ns()
            if now < self._next_ns:
                return False
            self._next_ns = now + self._period_ns
            return True
