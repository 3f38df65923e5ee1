"""The socket through which this process sends messages to others, and the count of who listens.

Publishers call send() from any thread; the I/O thread calls take_notices() when the descriptor is readable.
It is an XPUB socket: it tells which topics the connected processes have subscribed to, so that a publisher
can know when its first message will arrive. Frames of a message: topic, our address, bytes, type name.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (NodeShared::Publish)
"""

from __future__ import annotations

import threading
from collections.abc import Callable

import zmq

_NO_COPY_FROM_BYTES = 65536
_MORE, _EVENTS, _READABLE = int(zmq.SNDMORE), int(zmq.EVENTS), int(zmq.POLLIN)  # the plain numbers are faster


class Outlet:
    """The sending half of the data path between processes."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        ip: str,
        high_water_mark: int,
        on_change: Callable[[], None],
    ) -> None:
        """Bind a free port of `ip`; `on_change()` is called, with no lock held, when listeners change."""
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
        """Return the descriptor that becomes readable when take_notices() may have something."""
        return self._descriptor

    def listeners(self, name: bytes) -> int:
        """Return how many processes have subscribed to this fully qualified topic."""
        return self._listeners.get(name, 0)

    def send(self, name: bytes, data: bytes, type_name: bytes) -> None:
        """Send to the processes that have subscribed; never waits, so a slow process misses messages."""
        if not self._listeners.get(name):
            return
        with self._lock:
            if self._socket.closed:
                return
            send = self._send  # frame by frame: send_multipart() takes three times as long
            send(name, _MORE)
            send(self._address_on_wire, _MORE)
            send(data, _MORE, len(data) < _NO_COPY_FROM_BYTES)
            send(type_name)
            # sending may have used up the descriptor's signal, so what it signalled has to be looked for here
            changed = self._drain()
        if changed:
            self._on_change()

    def take_notices(self) -> None:
        """Count the subscriptions that came and went."""
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
        """Close the socket; messages under way are still sent for a moment."""
        with self._lock:
            self._socket.close()
