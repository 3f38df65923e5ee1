"""Calls the callbacks for messages of other processes, in one thread, in the order of arrival.

Between the I/O thread and the subscriptions. It is a thread of its own so that a callback may take its time,
and may itself advertise, subscribe or wait, without stopping discovery. When callbacks are too slow the queue
fills up and the I/O thread stops reading until there is room; ZeroMQ then drops, as it does in gz-transport.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from gz.transport import naming
from gz.transport.environment import complain
from gz.transport.inlet import Arrival
from gz.transport.message_info import MessageInfo
from gz.transport.switchboard import Switchboard


class Dispatcher:
    """A queue of messages and the thread that empties it."""

    def __init__(self, switchboard: Switchboard, limit: int, on_room: Callable[[], None]) -> None:
        """`limit` messages may wait (0: any number); `on_room()` is called when full() is over."""
        self._switchboard = switchboard
        self._limit = limit
        self._on_room = on_room
        self._queue: queue.SimpleQueue[Arrival | None] = queue.SimpleQueue()
        self._was_full = False
        self._thread = threading.Thread(target=self._run, name="gz-transport-callbacks", daemon=True)

    def start(self) -> None:
        """Starts the thread."""
        self._thread.start()

    def put(self, arrival: Arrival) -> None:
        """Queues a message."""
        self._queue.put(arrival)

    def full(self) -> bool:
        """Whether no more should be put in."""
        if self._limit and self._queue.qsize() >= self._limit:
            self._was_full = True
            # The queue may have been emptied between the two lines above; then nobody would call on_room().
            return self._queue.qsize() >= self._limit
        return False

    def stop(self, timeout: float) -> None:
        """Ends the thread after the callback it is in; waits at most `timeout` seconds for that."""
        self._limit = 0
        self._queue.put(None)
        if self._thread is not threading.current_thread():
            self._thread.join(timeout)

    def _run(self) -> None:
        while True:
            arrival = self._queue.get()
            if arrival is None:
                return
            try:
                self._deliver(arrival)
            except BaseException as error:  # SystemExit in a callback must not end the delivery of messages
                complain(f"Delivering a message of {arrival.name} ended with {type(error).__name__}: {error}")
            if self._was_full and self._queue.qsize() <= self._limit // 2:
                self._was_full = False
                self._on_room()

    def _deliver(self, arrival: Arrival) -> None:
        group = self._switchboard.networked_subscriptions(arrival.name)
        if not group:
            return
        partition, topic = naming.split(arrival.name)
        info = MessageInfo(topic, arrival.type_name, partition, False)
        for subscription in group:
            subscription.deliver(arrival.data, info)
