"""Waiting in tests: `eventually = within(120.0)` gives a function that waits for a condition, with this deadline."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any


def within(deadline: float, pause: float = 0.01) -> Callable[[Callable[[], Any], str], Any]:
    """Return `eventually(condition, what)`: what the condition returns as soon as it is true.

    It looks every `pause` [s], and fails with the name of `what` after `deadline` [s].
    """

    def eventually(condition: Callable[[], Any], what: str) -> Any:
        never, end = threading.Event(), time.monotonic() + deadline
        while not (found := condition()):
            assert time.monotonic() < end, f"not within {deadline} s: {what}"
            never.wait(pause)
        return found

    return eventually
