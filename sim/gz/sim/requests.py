"""The queue of functions that other threads pass to the thread that steps a world; they run between two steps.

Service callbacks run in threads of the transport, but only the stepping thread may access a world. They pass functions
to `Requests.call` or `put`; `World.step` and the paused `Server` call `serve`. A request by the stepping thread itself
runs at once, unless it is inside a step. The stepping thread is the one that created the world, until another thread
steps or serves it; that thread first waits for the end of a running request.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from gz_course.sim.error_text import named
from gz_course.sim.gz.sim.errors import LOG, SimError

PATIENCE_S = 5.0
"""Time [s] after which `call` withdraws a request that has not been served."""


class Request:
    """A queued function, its result and its error."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self.work = work
        self.done = threading.Event()
        self.result: Any = None
        self.error: Exception | None = None
        self._taken = threading.Lock()

    def take(self) -> bool:
        """Claim the request for running or withdrawing it; return True for the first caller only."""
        return self._taken.acquire(blocking=False)

    def run(self) -> None:
        """Run the function, unless its caller has withdrawn the request."""
        if not self.take():
            return
        try:
            self.result = self.work()
        except Exception as error:  # raised again in the caller; the world continues
            self.error = error
        finally:
            self.done.set()


class Requests:
    """The queue of one world; thread-safe, except for methods of the stepping thread."""

    def __init__(self) -> None:
        self.waiting: deque[Request] = deque()
        """The queue; a plain deque, because `World.step` checks it before every step."""
        self._arrived = threading.Condition()
        self._owner = threading.get_ident()
        self._handover = threading.RLock()
        """Held while `put` runs a function directly, so that no other thread starts stepping in the meantime."""
        self._inside = False

    def __bool__(self) -> bool:
        return bool(self.waiting)

    def own(self) -> None:
        """Make the calling thread the stepping thread."""
        caller = threading.get_ident()
        if caller != self._owner:
            with self._handover:
                self._owner = caller

    def enter_step(self) -> None:
        """Record that the stepping thread is inside a step."""
        self._inside = True

    def leave_step(self) -> None:
        self._inside = False

    def refuse_inside_step(self, what: str) -> None:
        """Raise SimError if a system calls this during a step; `what` completes "a world cannot ..."."""
        if self._inside:
            raise SimError(
                f"a world cannot {what} in the middle of a step; pass the function to world.requests.put instead"
            )

    def put(self, work: Callable[[], Any]) -> Request:
        """Queue a function, or run it directly if the caller is the stepping thread between two steps."""
        request = Request(work)
        if threading.get_ident() == self._owner and not self._inside:
            with self._handover:
                if threading.get_ident() == self._owner:
                    request.run()
                    return request
        with self._arrived:
            self.waiting.append(request)
            self._arrived.notify_all()
        return request

    def call(self, work: Callable[[], Any], patience: float = PATIENCE_S) -> Any:
        """Run a function in the stepping thread; return its result or raise its error.

        Raises SimError without running it if the world was not stepped for `patience` [s], or if the caller is inside a
        step, where waiting would be a deadlock.
        """
        request = self.put(work)
        if threading.get_ident() == self._owner and not request.done.is_set():
            request.take()
            raise SimError("the world is in the middle of a step and cannot be changed from there; ask between steps")
        if not request.done.wait(patience) and request.take():
            raise SimError(f"the world was not stepped for {patience:g} s, so the request was given up")
        request.done.wait()
        if request.error is not None:
            raise request.error
        return request.result

    def serve(self) -> None:
        """Run the queued requests; called by the stepping thread between steps.

        A function passed to `put` must handle its own errors.
        """
        self.own()
        for _ in range(len(self.waiting)):
            self.waiting.popleft().run()

    def wait(self, timeout: float) -> None:
        """Return when a request is queued, or after `timeout` [s]."""
        with self._arrived:
            self._arrived.wait_for(lambda: bool(self.waiting), timeout)


def logged(work: Callable[[], Any], about: str) -> Callable[[], bool]:
    """Wrap a function whose result has no receiver: log an error in one sentence about `about`; return success."""

    def run() -> bool:
        try:
            work()
        except SimError as error:
            LOG.error("%s: %s", about, error)
            return False
        except Exception as error:
            LOG.error("%s: it failed inside the simulator (%s)", about, named(error))
            return False
        return True

    return run
