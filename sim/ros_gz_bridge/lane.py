"""A thread of its own for the messages of one heavy topic, so that an image does not delay the clock.

``link.GzToRos`` puts large messages in and goes on at once to the next topic; the lane converts and publishes them in
their order. It holds a bounded number of them: when they come faster than they can be bridged the oldest give way, as
in a queue of DDS.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

HEAVY_BYTES = 64 * 1024
"""From this size on, serialized, a message is worth a thread of its own."""
_MOST_BYTES = 128 * 1024 * 1024
_AT_LEAST = 2
_STOP_WITHIN_S = 1.0


class Lane:
    """Calls ``work(data)`` for everything that is put in, in one thread, in order."""

    def __init__(self, name: str, work: Callable[[bytes], None], depth: int, skipped: Callable[[], None]) -> None:
        """At most ``depth`` messages and 128 MiB wait; ``skipped()`` is called for each that had to give way."""
        self._work = work
        self._depth = max(depth, _AT_LEAST)
        self._skipped = skipped
        self._waiting: deque[bytes] = deque()
        self._bytes = 0
        self._open = True
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name=f"lane {name}", daemon=True)
        self._thread.start()

    def put(self, data: bytes) -> None:
        """Queue a message; never waits."""
        gone = 0
        with self._changed:
            self._waiting.append(data)
            self._bytes += len(data)
            while len(self._waiting) > self._depth or (self._bytes > _MOST_BYTES and len(self._waiting) > _AT_LEAST):
                self._bytes -= len(self._waiting.popleft())
                gone += 1
            self._changed.notify()
        for _ in range(gone):
            self._skipped()

    def close(self) -> None:
        """End the thread after the message it is at; what waits is dropped."""
        with self._changed:
            self._open = False
            self._waiting.clear()
            self._changed.notify()
        if self._thread is not threading.current_thread():
            self._thread.join(_STOP_WITHIN_S)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or not self._open)
                if not self._open:
                    return
                data = self._waiting.popleft()
                self._bytes -= len(data)
            self._work(data)
