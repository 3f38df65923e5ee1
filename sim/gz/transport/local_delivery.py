"""The thread that calls the callbacks of messages published in the same process.

As in gz-transport, publish() does not call them itself: a program may publish while it holds a lock that its callback
takes. The thread starts with the first message for it.

Finalizers of forgotten nodes and publishers run at any moment, even while their thread holds a lock. They leave their
work to the I/O thread of the network, or, where there is none, to this thread or the next node that is made.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (PublishThread)
"""

from __future__ import annotations

import os
import queue
import sys
import threading
from collections.abc import Callable, Sequence

from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.subscription import Subscription

MANY_WAITING = 10_000
"""The number of waiting messages at which the user is warned: no message is dropped, so a slow callback costs
memory."""


class LocalDelivery:
    """The queue of one process and its thread; all methods may be called from any thread."""

    def __init__(self) -> None:
        self._queue: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None
        self._warned = False

    def deliver(self, group: Sequence[Subscription], data: bytes, info: MessageInfo, from_node: str) -> None:
        """Queue a message for these subscriptions, which get it in this order."""
        if self._thread is None:
            self._start()

        def call() -> None:
            for subscription in group:
                subscription.deliver(data, info, from_node)

        self._queue.put(call)
        if not self._warned and self._queue.qsize() > MANY_WAITING:
            self._warned = True
            complain(
                f"More than {MANY_WAITING} messages of this process wait for its callbacks, the last one on "
                f"[{info.topic}]: the callbacks take longer than the time between two messages, so memory runs full."
            )

    def end_later(self, work: Callable[[], None]) -> None:
        """Leave the work of a finalizer to another thread; takes no lock."""
        module = sys.modules.get(f"{__package__}.process_network")
        network = module.present() if module else None
        if network:
            network.do(work)
        else:
            self._queue.put(work)

    def tidy(self) -> None:
        """Do the queued work of finalizers here if there is no thread that does it."""
        while self._thread is None:
            try:
                work = self._queue.get_nowait()
            except queue.Empty:
                return
            work()

    def renew_after_fork(self) -> None:
        """Give the forked child a queue of its own; its parent delivers what is in the old one."""
        self.__init__()  # type: ignore[misc]

    def _start(self) -> None:
        """Start the thread if it does not run yet."""
        with self._starting:
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="gz-transport-local", daemon=True)
                self._thread.start()

    def _run(self) -> None:
        while True:
            work = self._queue.get()
            try:
                work()
            except BaseException as error:  # SystemExit in a callback must not stop delivery
                complain(f"Delivering a message within the process ended with {type(error).__name__}: {error}")
            del work  # it must not keep a forgotten node alive until the next message


LOCAL_DELIVERY = LocalDelivery()
os.register_at_fork(after_in_child=LOCAL_DELIVERY.renew_after_fork)
