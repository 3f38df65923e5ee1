"""The queue of what other threads want done to a world; it is done between two steps.

Service callbacks run in the threads of the transport; nothing but the stepping thread may touch a world. They
hand their work to `Requests.call` or `put`; `World.step` and the paused `Server` call `serve`. Whoever is the
stepping thread itself, and not inside a step, is served at once: so a program that steps a world and calls its
services never waits for itself. The stepping thread is who made the world, until another thread steps or serves it;
that one waits until what is being done at once is done.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from gz_course.sim.gz.sim.errors import LOG, SimError

PATIENCE_S = 5.0
"""How long a caller waits for its work to be done. When nobody steps the world by then, it is not done at all."""


class Request:
    """One piece of work and what became of it."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self.work = work
        self.done = threading.Event()
        self.result: Any = None
        self.error: Exception | None = None
        self._taken = threading.Lock()

    def take(self) -> bool:
        """Claim the work, to do it or to give it up; True for the first who asks."""
        return self._taken.acquire(blocking=False)

    def run(self) -> None:
        """Do the work, unless the caller has given it up."""
        if not self.take():
            return
        try:
            self.result = self.work()
        except Exception as error:  # the caller's, and not a reason to stop the world
            self.error = error
        finally:
            self.done.set()


class Requests:
    """The queue of one world. Thread-safe, except for what is said to belong to the stepping thread."""

    def __init__(self) -> None:
        self.waiting: deque[Request] = deque()
        """The queue; whoever steps looks at it before every step, so it is no more than that."""
        self._arrived = threading.Condition()
        self._owner = threading.get_ident()
        self._handover = threading.RLock()
        """Held while work is done at once, so that no other thread begins to step meanwhile."""
        self._inside = False

    def __bool__(self) -> bool:
        """Return whether something waits."""
        return bool(self.waiting)

    def own(self) -> None:
        """Make the calling thread the stepping thread, from now on."""
        caller = threading.get_ident()
        if caller != self._owner:
            with self._handover:
                self._owner = caller

    def enter_step(self) -> None:
        """Note that the calling thread, which owns the world, is inside a step."""
        self._inside = True

    def leave_step(self) -> None:
        """Note that the step is over."""
        self._inside = False

    def refuse_inside_step(self, what: str) -> None:
        """Raise `SimError` when a system asks for a change of the world while it is being stepped."""
        if self._inside:
            raise SimError(f"a world cannot {what} in the middle of a step; put the work into world.requests instead")

    def put(self, work: Callable[[], Any]) -> Request:
        """Queue work, or do it at once when the caller is the stepping thread between two steps."""
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
        """Have work done and return its result; raise what it raised.

        Raises `SimError` when the world was not stepped for `patience` seconds, or when called from inside a step by
        the stepping thread, which would wait for itself; the work is then not done.
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
        """Do the work that waits now; called by the stepping thread between steps. Errors nobody waits for are the
        business of the work itself.
        """
        self.own()
        for _ in range(len(self.waiting)):
            self.waiting.popleft().run()

    def wait(self, timeout: float) -> None:
        """Return when work waits, or after `timeout` seconds."""
        with self._arrived:
            self._arrived.wait_for(lambda: bool(self.waiting), timeout)


def logged(work: Callable[[], Any], about: str) -> Callable[[], bool]:
    """Wrap work nobody waits for: what goes wrong becomes one logged sentence about `about`; returns success."""

    def run() -> bool:
        try:
            work()
        except SimError as error:
            LOG.error("%s: %s", about, error)
            return False
        except Exception as error:
            LOG.error("%s: it failed inside the simulator (%s: %s)", about, type(error).__name__, error)
            return False
        return True

    return run
