"""An event in real time, for the agent itself: its waits are none of the submission's."""

from __future__ import annotations

import _thread


class Signal:
    """Like `threading.Event`; one thread waits for it at a time."""

    def __init__(self) -> None:
        self._lock = _thread.allocate_lock()
        self._lock.acquire()

    def set(self) -> None:
        if self._lock.locked():
            self._lock.release()

    def clear(self) -> None:
        self._lock.acquire(False)

    def wait(self, timeout: float | None = None) -> bool:
        """Return whether it was set, within `timeout` seconds."""
        if not self._lock.acquire(True, -1 if timeout is None else timeout):
            return False
        self._lock.release()
        return True
