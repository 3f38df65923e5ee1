"""Sends messages to other processes and counts their subscriptions.

Publishers call send() from any thread; the I/O thread calls take_notices() when the descriptor is readable. An XPUB
socket reports the topics that connected processes subscribe to, so that a publisher can tell whether its first message
will arrive. Frames of a message: topic, own address, bytes, type name.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (NodeShared::Publish)
"""

from __future__ import annotations

import threading
from collections.abc import Callable

import zmq

_NO_COPY_FROM_BYTES = 65536
_MORE, _EVENTS, _READABLE = int(zmq.SNDMORE), int(zmq.EVENTS), int(zmq.POLLIN)  # plain ints are faster


class Outlet:
    """The sending side of messages between processes."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        ip: str,
        high_water_mark: int,
        on_change: Callable[[], None],
    ) -> None:
        """Bind a free port of `ip`; `on_change()` is called without a lock when the subscriptions change."""
        self._on_change = on_change
        self._lock = threading.Lock()
        self._listeners: dict[bytes, int] = {}
        self._socket = context.socket(zmq.XPUB)
        self._socket.setsockopt(zmq.LINGER, 200)
        self._socket.setsockopt(zmq.SNDHWM, high_water_mark)
        self._socket.setsockopt(zmq.XPUB_VERBOSER, 1)
        self._send, self._events = self._socket.send, self._socket.getsockopt
        self._socket.bind(f"tcp://{ip}:*")
        self.address: str = self._socket.getsockopt_string(zmq.LAST_ENDPOINT)
        self._address_on_wire = self.address.encode()
        self._descriptor = int(self._socket.getsockopt(zmq.FD))

    def fileno(self) -> int:
        """Return the file descriptor that is readable when take_notices() may have work."""
        return self._descriptor

    def listeners(self, name: bytes) -> int:
        """Return how many processes subscribe to this fully qualified topic."""
        return self._listeners.get(name, 0)

    def send(self, name: bytes, data: bytes, type_name: bytes) -> None:
        """Send to the subscribed processes; does not block, so a slow process misses messages."""
        if not self._listeners.get(name):
            return
        with self._lock:
            if self._socket.closed:
                return
            send = self._send  # frame by frame, because send_multipart() takes three times as long
            send(name, _MORE)
            send(self._address_on_wire, _MORE)
            send(data, _MORE, len(data) < _NO_COPY_FROM_BYTES)
            send(type_name)
            # sending may consume the signal of the edge-triggered descriptor, so its cause is checked here
            changed = self._drain()
        if changed:
            self._on_change()

    def take_notices(self) -> None:
        """Update the counts of subscriptions."""
        with self._lock:
            changed = not self._socket.closed and self._drain()
        if changed:
            self._on_change()

    def _drain(self) -> bool:
        changed = False
        while int(self._events(_EVENTS)) & _READABLE:
            notice: bytes = self._socket.recv(zmq.NOBLOCK)
            kind, name = notice[:1], notice[1:]
            if kind in (b"\x00", b"\x01"):
                count = self._listeners.get(name, 0) + (1 if kind == b"\x01" else -1)
                if count > 0:
                    self._listeners[name] = count
                else:
                    self._listeners.pop(name, None)
                changed = True
        return changed

    def close(self) -> None:
        """Close the socket; messages in transit are still sent for a moment."""
        with self._lock:
            self._socket.close()
