"""Joins several reports into one."""

from __future__ import annotations

import threading
from collections.abc import Callable


class ReadyAggregator:
    """Calls `delegate` once, when `ready_fn` was called `num_to_aggregate` times; thread-safe."""

    def __init__(self, delegate: Callable[[], object], num_to_aggregate: int) -> None:
        self._delegate = delegate
        self._missing = num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        with self._lock:
            self._missing -= 1
            if self._missing == 0:
                self._delegate()
