"""A thread for the large messages of one topic, so that an image does not delay the clock.

`link.GzToRos` queues the messages; the worker converts and publishes them in order. The queue is bounded: if it is full
the oldest messages are dropped, as in DDS with history KEEP_LAST.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

HEAVY_BYTES = 64 * 1024
"""Minimum serialized size [byte] of the messages that a worker bridges."""
_MOST_BYTES = 128 * 1024 * 1024
_AT_LEAST = 2
_STOP_WITHIN_S = 1.0


class Worker:
    """A thread that calls `work(data)` for all queued data, in order. Thread-safe.

    The queue holds at most `depth` messages and 128 MiB; `skipped()` is called for each dropped message.
    """

    def __init__(self, name: str, work: Callable[[bytes], None], depth: int, skipped: Callable[[], None]) -> None:
        self._work = work
        self._depth = max(depth, _AT_LEAST)
        self._skipped = skipped
        self._waiting: deque[bytes] = deque()
        self._bytes = 0
        self._open = True
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name=f"worker {name}", daemon=True)
        self._thread.start()

    def put(self, data: bytes) -> None:
        """Queue a message without waiting."""
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
        """End the thread after the current message and drop the queued ones."""
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
