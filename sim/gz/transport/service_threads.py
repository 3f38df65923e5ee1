"""The threads that run service callbacks for requests of other processes, one at a time.

A further thread runs only while a callback waits for the response to its own request, so that two processes can call
each other without a deadlock.
"""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Callable, Iterator

from gz_course.sim.gz.transport.environment import complain

_MOST_QUEUED = 1000
_MOST_THREADS = 32
_own = threading.local()


class ServiceThreads:
    """A queue of functions and the threads that run them: one at a time, others wait for responses."""

    def __init__(self, on_room: Callable[[], None]) -> None:
        """`on_room()` is called when full() becomes False again."""
        self._on_room = on_room
        self._queue: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._turn = threading.Lock()
        self._count_lock = threading.Lock()
        self._free = 0  # threads in their loop, not waiting inside a callback
        self._all = 0
        self._was_full = False
        self._open = True

    def put(self, work: Callable[[], None]) -> None:
        """Queue a function; the first call starts the first thread."""
        self._queue.put(work)
        if not self._all:
            self._start_one()

    def full(self) -> bool:
        if self._queue.qsize() < _MOST_QUEUED:
            return False
        self._was_full = True
        return self._queue.qsize() >= _MOST_QUEUED

    def _start_one(self) -> None:
        with self._count_lock:
            if self._free or self._all >= _MOST_THREADS or not self._open:
                return
            self._free += 1
            self._all += 1
        threading.Thread(target=self._run, name="gz-transport-services", daemon=True).start()

    def _run(self) -> None:
        _own.threads = self
        while True:
            with self._count_lock:
                if self._free > 1:  # another thread has returned from waiting: one loop is enough
                    self._free -= 1
                    self._all -= 1
                    return
            work = self._queue.get()
            if work is None:
                self._queue.put(None)  # wakes the next thread
                return
            with self._turn:
                try:
                    work()
                except BaseException as error:  # SystemExit in a callback must not end the service
                    complain(f"A service callback ended with {type(error).__name__}: {error}")
            if self._was_full and self._queue.qsize() <= _MOST_QUEUED // 2:
                self._was_full = False
                self._on_room()

    def stop(self) -> None:
        """End the threads after their current callbacks."""
        self._open = False
        self._queue.put(None)

    def _wait_elsewhere(self) -> None:
        with self._count_lock:
            self._free -= 1
        self._turn.release()
        self._start_one()

    def _come_back(self) -> None:
        self._turn.acquire()
        with self._count_lock:
            self._free += 1


@contextlib.contextmanager
def while_waiting() -> Iterator[None]:
    """Allow the next service callback to run while this one waits for a response."""
    threads: ServiceThreads | None = getattr(_own, "threads", None)
    if threads is None:
        yield
        return
    threads._wait_elsewhere()
    try:
        yield
    finally:
        threads._come_back()
