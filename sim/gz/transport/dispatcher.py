"""The thread that receives messages of other processes and calls subscription callbacks in the order of arrival.

It has its own thread, so that a slow callback, or one that advertises, subscribes or waits, does not stop discovery,
and it reads the socket itself, to save a thread switch per message. If callbacks are too slow, ZeroMQ's queue fills up
and drops messages.
"""

from __future__ import annotations

import select
import socket
import threading

from gz_course.sim.error_text import named
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.inlet import Arrival, Inlet
from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.switchboard import Switchboard
from gz_course.sim.gz.transport.topic_statistics import StatisticsTable

_MOST_DESCRIBED = 1000


class Dispatcher:
    """The thread that reads messages from the inlet."""

    def __init__(self, switchboard: Switchboard, inlet: Inlet, statistics: StatisticsTable) -> None:
        self._switchboard = switchboard
        self._statistics = statistics
        self._inlet = inlet
        self._described: dict[tuple[bytes, bytes], tuple[str, MessageInfo]] = {}
        self._open = True
        self._wake_sender, self._wake_receiver = socket.socketpair()
        self._wake_sender.setblocking(False)
        self._wake_receiver.setblocking(False)
        self._thread = threading.Thread(target=self._run, name="gz-transport-callbacks", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def wake(self) -> None:
        """Make the thread check the socket, because another user of the socket may have consumed its signal."""
        try:
            self._wake_sender.send(b"!")
        except OSError:  # full: it will wake up anyway; closed: it has stopped
            return

    def stop(self, timeout: float) -> bool:
        """Stop the thread after its current callback; wait at most `timeout` [s] and return whether it has ended."""
        self._open = False
        self.wake()
        if self._thread is not threading.current_thread():
            self._thread.join(timeout)
        return not self._thread.is_alive()

    def close(self) -> None:
        self._wake_sender.close()
        self._wake_receiver.close()

    def _run(self) -> None:
        wake, message = self._wake_receiver.fileno(), self._inlet.fileno()
        poller = select.poll()
        poller.register(wake, select.POLLIN)
        poller.register(message, select.POLLIN)
        receive = self._inlet.receive
        while self._open:
            arrival = receive()
            if arrival is None:
                for descriptor, _ in poller.poll():
                    if descriptor == wake:
                        self._wake_receiver.recv(4096)
                continue
            try:
                self._deliver(arrival)
            except BaseException as error:  # SystemExit in a callback must not stop delivery
                complain(f"Delivering a message of {arrival.name!r} ended with {named(error)}")

    def _deliver(self, arrival: Arrival) -> None:
        found = self._described.get((arrival.name, arrival.type_name))
        if found is None:
            found = self._describe(arrival)
            if found is None:
                return
        name, info = found
        if arrival.stamp:
            self._statistics.record(name, arrival.sender, arrival.stamp)
        for subscription in self._switchboard.networked_subscriptions(name):
            subscription.deliver(arrival.data, info)

    def _describe(self, arrival: Arrival) -> tuple[str, MessageInfo] | None:
        try:
            name, type_name = arrival.name.decode(), arrival.type_name.decode()
            partition, topic = naming.split(name)
        except ValueError:  # invalid name or invalid UTF-8
            return None
        if len(self._described) >= _MOST_DESCRIBED:
            self._described.clear()
        found = name, MessageInfo(topic, type_name, partition, False)
        self._described[arrival.name, arrival.type_name] = found
        return found
