"""Sends messages to other processes and counts their subscriptions.

Publishers call send() from any thread; the I/O thread calls take_notices() when the descriptor is readable. An XPUB
socket reports the topics that connected processes subscribe to, so that a publisher can tell whether its first message
will arrive. The reports are kept for each connection, so that nobody can end the subscription of another. Frames of a
message: topic, own address, bytes, type name, and, where statistics are on, its time and number.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (NodeShared::Publish)
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

import zmq

from gz_course.sim.gz.transport.topic_statistics import STAMP, now_ms

_NO_COPY_FROM_BYTES = 65536
_HOLD_NS = 1_000_000
"""Time [ns] after which `hold` keeps no message back."""
_MORE, _EVENTS, _READABLE = int(zmq.SNDMORE), int(zmq.EVENTS), int(zmq.POLLIN)  # plain ints are faster

Connection = tuple[int, int, int]
"""A TCP connection: its file descriptor, and device and inode, which tell it from a later one of that descriptor."""


class Outlet:
    """The sending side of messages between processes."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        ip: str,
        high_water_mark: int,
        on_change: Callable[[], None],
        statistics: bool = False,
    ) -> None:
        """Bind a free port of `ip`; `on_change()` is called without a lock when the subscriptions change.

        With `statistics` each message has a fifth frame with its time and number.
        """
        self._waiting: list[tuple[bytes, bytes, bytes]] = []
        self._holding, self._hold_until = False, 0
        self._numbers: dict[bytes, int] | None = {} if statistics else None
        self._on_change = on_change
        self._lock = threading.Lock()
        self._listeners: dict[bytes, set[Connection]] = {}
        self._left: set[bytes] = set()  # topics that a closed connection had, which was not found closed yet
        self._socket = context.socket(zmq.XPUB)
        self._socket.setsockopt(zmq.LINGER, 200)
        self._socket.setsockopt(zmq.SNDHWM, high_water_mark)
        self._socket.setsockopt(zmq.XPUB_VERBOSER, 1)
        # These methods of the compiled class are much faster than those of the Python class around it.
        self._send, self._events = super(zmq.Socket, self._socket).send, super(zmq.Socket, self._socket).get
        self._socket.bind(f"tcp://{ip}:*")
        self.address: str = self._socket.getsockopt_string(zmq.LAST_ENDPOINT)
        self._address_on_wire = self.address.encode()
        self._descriptor = int(self._socket.getsockopt(zmq.FD))

    def fileno(self) -> int:
        """Return the file descriptor that is readable when take_notices() may have work."""
        return self._descriptor

    def listeners(self, name: bytes) -> int:
        """Return how many processes subscribe to this fully qualified topic."""
        if name in self._left:
            with self._lock:
                self._forget_closed(name)
        return len(self._listeners.get(name, ()))

    def is_leaving(self, name: bytes) -> bool:
        """Return whether `listeners` may change without a notice."""
        return name in self._left

    def send(self, name: bytes, data: bytes, type_name: bytes) -> None:
        """Send to the subscribed processes; does not block, so a slow process misses messages."""
        if name not in self._listeners:
            return
        with self._lock:
            self._waiting.append((name, data, type_name))
            if self._holding and time.monotonic_ns() < self._hold_until:
                return
            changed = self._send_waiting()
        if changed:
            self._on_change()

    def hold(self) -> None:
        """Keep the messages of all threads for a moment, at most until `let_go`, so that many leave together."""
        with self._lock:
            self._holding, self._hold_until = True, time.monotonic_ns() + _HOLD_NS

    def let_go(self) -> None:
        """Send the messages that were kept."""
        with self._lock:
            self._holding = False
            changed = self._send_waiting()
        if changed:
            self._on_change()

    def _send_waiting(self) -> bool:
        """Send the waiting messages in their order; return whether the subscriptions have changed."""
        if not self._waiting:
            return False
        waiting, self._waiting = self._waiting, []
        if self._holding:
            self._hold_until = time.monotonic_ns() + _HOLD_NS
        if self._socket.closed:
            return False
        for name, data, type_name in waiting:
            self._send_frames(name, data, type_name)
        # sending may consume the signal of the edge-triggered descriptor, so its cause is checked here
        return self._drain()

    def _send_frames(self, name: bytes, data: bytes, type_name: bytes) -> None:
        send = self._send  # frame by frame, because send_multipart() takes three times as long
        send(name, _MORE, True)
        send(self._address_on_wire, _MORE, True)
        if len(data) < _NO_COPY_FROM_BYTES:
            send(data, _MORE, True)
        else:
            send(data, _MORE, copy=False)
        if self._numbers is None:
            send(type_name, 0, True)
            return
        number = self._numbers.get(name, 0)
        self._numbers[name] = number + 1
        send(type_name, _MORE, True)
        send(STAMP.pack(now_ms(), number), 0, True)

    def take_notices(self) -> None:
        """Update the counts of subscriptions."""
        with self._lock:
            changed = not self._socket.closed and self._drain()
        if changed:
            self._on_change()

    def _drain(self) -> bool:
        changed = False
        while int(self._events(_EVENTS)) & _READABLE:
            frame = self._socket.recv(zmq.NOBLOCK, copy=False)
            notice = frame.bytes
            kind, name = notice[:1], notice[1:]
            if kind == b"\x01":
                self._listeners.setdefault(name, set()).add(_connection(frame))
                changed = True
            elif kind == b"\x00" and name in self._listeners:
                self._end(name, frame)
                changed = True
        return changed

    def _end(self, name: bytes, frame: zmq.Frame) -> None:
        """End the subscription of the connection that sent this notice; ZeroMQ itself sends it for a closed one."""
        group, connection = self._listeners[name], _connection(frame)
        if connection[0] < 0:
            self._forget_closed(name)
        elif connection in group:
            self._remove(name, {connection})

    def _forget_closed(self, name: bytes) -> None:
        group = self._listeners.get(name, set())
        closed = {each for each in group if not _is_open(each)}
        if closed or not group:
            self._left.discard(name)
            self._remove(name, closed)
        else:  # ZeroMQ's thread is about to close it
            self._left.add(name)

    def _remove(self, name: bytes, connections: set[Connection]) -> None:
        group = self._listeners.get(name, set()) - connections
        if group:
            self._listeners[name] = group
        else:
            self._listeners.pop(name, None)
            self._left.discard(name)

    def close(self) -> None:
        """Close the socket; messages in transit are still sent for a moment."""
        with self._lock:
            self._socket.close()


def _connection(frame: zmq.Frame) -> Connection:
    """Return the connection that a frame came from; its descriptor is -1 if there is none or it is closed."""
    try:
        descriptor = int(frame.get(zmq.SRCFD))
        status = os.fstat(descriptor)
    except (zmq.ZMQError, OSError):
        return -1, 0, 0
    return descriptor, status.st_dev, status.st_ino


def _is_open(connection: Connection) -> bool:
    try:
        status = os.fstat(connection[0])
    except OSError:
        return False
    return connection[1:] == (status.st_dev, status.st_ino)
