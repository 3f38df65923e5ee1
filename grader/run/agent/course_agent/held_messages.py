"""The messages that a process has sent and that have not left it: they wait for the grader's order `release`."""

from __future__ import annotations

import contextlib
from collections import deque
from collections.abc import Callable

from .thread_monitor import sleep

UNMATCHED_SLICE = 0.005  # [s] between two looks at an unmatched publisher; DDS gives no event we could wait for


class HeldMessages:
    """A queue of what is to be sent. `holding` is what the grader has ordered, `released` how many orders were met."""

    def __init__(self, holding: bool) -> None:
        self.holding = holding
        self.released = 0
        self._queue: deque[tuple[Callable[[], None], Callable[[float], bool]]] = deque()

    def __len__(self) -> int:
        return len(self._queue)

    def add(self, send: Callable[[], None], may_leave: Callable[[float], bool]) -> None:
        """Queue a message to be sent, once `may_leave` at a time [s] of the run."""
        self._queue.append((send, may_leave))

    def release(self, now: float) -> None:
        """Send the first message, or none while that may not leave yet: then the order comes again."""
        if self._queue and not self._queue[0][1](now):
            self.released += 1
            sleep(UNMATCHED_SLICE)
        else:
            self._send_next()

    def let_go(self) -> None:
        """Hold nothing any more, and send what was held."""
        self.holding = False
        self.send_all()

    def send_all(self) -> None:
        """Send what is held, in its order."""
        while self._queue:
            self._send_next()

    def _send_next(self) -> None:
        with contextlib.suppress(IndexError):
            send, _ = self._queue.popleft()
            with contextlib.suppress(Exception):  # its publisher may be destroyed already, as in a process that ends
                send()
        self.released += 1
