"""The lock on which conditions, events and queues wait, so that their waits are watched."""

from __future__ import annotations

import _thread

from .thread_monitor import ThreadMonitor, Wait


class WatchedLock:
    """A lock whose waiters are watched: the locks on which conditions, events and queues wait."""

    def __init__(self, threads: ThreadMonitor) -> None:
        self._threads = threads
        self._lock = _thread.allocate_lock()
        self._wait: Wait | None = None

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        threads = self._threads
        if self._lock.acquire(False):
            return True
        if not blocking or timeout == 0:
            return False
        if threads.mine() is None:
            return self._lock.acquire(True, timeout)
        if timeout > 0 and not threads.simulated:
            with threads.waiting():
                return self._lock.acquire(True, timeout)
        deadline = threads.after(timeout) if timeout > 0 else None
        with threads.lock:
            if self._lock.acquire(False):
                return True
            wait = self._wait = threads.open(deadline, self._lock.release)
        assert wait is not None
        if threads.idle:
            threads.on_idle()
        try:
            self._lock.acquire()
        finally:
            with threads.lock:
                threads.rouse(wait)
                self._wait = None
        if wait.cut and deadline is not None:
            return self._lock.acquire(True, (deadline - threads.now_ns) / 1e9 / threads.rate)
        return not wait.timed_out

    def release(self) -> None:
        with self._threads.lock:
            wait, self._wait = self._wait, None
            if wait is not None:
                self._threads.rouse(wait)
                if wait.timed_out or wait.cut:
                    return  # released already
            self._lock.release()

    def locked(self) -> bool:
        return self._lock.locked()
