"""Receives messages of other processes.

The I/O thread connects the SUB socket to the publishers found by discovery and sets a filter for each topic; the
dispatcher thread receives. ZeroMQ filters by prefix, so the exact name is compared again on delivery.

Source: https://zguide.zeromq.org/docs/chapter1/ (publish-subscribe)
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator
from typing import NamedTuple

import zmq

from gz_course.sim.gz.transport.environment import complain

LEAVE_AFTER_S = 5.0
"""Time [s] that the connection to an ended publisher stays open, because its last messages may be unread."""
_LARGEST_FRAME = 1 << 30
_FRAMES = 4
_MORE, _NO_WAIT = int(zmq.RCVMORE), int(zmq.NOBLOCK)  # plain ints are faster
_MOST_UNUSABLE = 1000
_MOST_CONNECTIONS = 256
_RECONNECT_MS, _RECONNECT_MOST_MS = 100, 2000


class Arrival(NamedTuple):
    """A message of another process."""

    name: bytes
    """Fully qualified topic."""
    sender: bytes
    """Address of the sending process."""
    data: bytes
    type_name: bytes
    stamp: bytes
    """Time and number for statistics, or empty."""


class Inlet:
    """The receiving side of messages between processes."""

    def __init__(self, context: zmq.Context[zmq.Socket[bytes]], high_water_mark: int) -> None:
        self._lock = threading.Lock()
        self.socket = context.socket(zmq.SUB)
        self.socket.setsockopt(zmq.LINGER, 0)
        self.socket.setsockopt(zmq.RCVHWM, high_water_mark)
        self.socket.setsockopt(zmq.RECONNECT_IVL, _RECONNECT_MS)
        self.socket.setsockopt(zmq.RECONNECT_IVL_MAX, _RECONNECT_MOST_MS)
        self.socket.setsockopt(zmq.MAXMSGSIZE, _LARGEST_FRAME)
        self._descriptor = int(self.socket.getsockopt(zmq.FD))
        self._was_used = False
        self._connected: dict[str, None] = {}  # the last entry is the most recently advertised address
        self._unusable: set[str] = set()
        self._leaving: dict[str, float] = {}
        self._filters: set[str] = set()

    @contextlib.contextmanager
    def _using(self) -> Iterator[None]:
        with self._lock:
            self._was_used = True
            yield

    def was_used(self) -> bool:
        """Return and clear whether the socket was used other than by receive(), which must then check it again."""
        used, self._was_used = self._was_used, False
        return used

    def fileno(self) -> int:
        """Return the file descriptor that is readable when receive() may return a message."""
        return self._descriptor

    def listen(self, name: str, address: str) -> bool:
        """Receive a topic from the process at `address`; return False if the address is not usable."""
        self._leaving.pop(address, None)
        if name not in self._filters:
            with self._using():
                self.socket.setsockopt(zmq.SUBSCRIBE, name.encode())
            self._filters.add(name)
        if address not in self._connected:
            if not self._connect(address):
                if address not in self._unusable and len(self._unusable) < _MOST_UNUSABLE:
                    self._unusable.add(address)
                    complain(f"The publisher of {name} has an address that cannot be used: {address[:100]!r}.")
                return False
            if len(self._connected) >= _MOST_CONNECTIONS:
                self._leave(next(iter(self._leaving), next(iter(self._connected))))
        else:
            del self._connected[address]
        self._connected[address] = None
        return True

    def _connect(self, address: str) -> bool:
        if not address.startswith("tcp://"):
            return False
        try:
            with self._using():
                self.socket.connect(address)
        except zmq.ZMQError:
            return False
        return True

    def ignore(self, name: str) -> None:
        if name in self._filters:
            self._filters.remove(name)
            with self._using():
                self.socket.setsockopt(zmq.UNSUBSCRIBE, name.encode())

    def leave_soon(self, address: str) -> None:
        """Disconnect from a process that has ended, after a delay for its last messages."""
        if address in self._connected:
            self._leaving.setdefault(address, time.monotonic() + LEAVE_AFTER_S)

    def leave_due(self) -> None:
        """Disconnect from the addresses whose delay has passed."""
        if not self._leaving:
            return
        now = time.monotonic()
        leaving = [address for address, due in self._leaving.items() if now >= due]
        for address in leaving:
            self._leave(address)

    def _leave(self, address: str) -> None:
        self._leaving.pop(address, None)
        self._connected.pop(address, None)
        with self._using(), contextlib.suppress(zmq.ZMQError):
            self.socket.disconnect(address)

    def receive(self) -> Arrival | None:
        """Return the next message, or None if there is none; does not block."""
        receive, more = self.socket.recv, self.socket.getsockopt
        while True:
            with self._lock:
                try:
                    frames: list[bytes] = [receive(_NO_WAIT)]
                except zmq.Again:
                    return None
                while more(_MORE):
                    frames.append(receive())
            if len(frames) >= _FRAMES:
                name, sender, data, type_name = frames[:_FRAMES]
                return Arrival(name, sender, data, type_name, frames[_FRAMES] if len(frames) > _FRAMES else b"")

    def close(self) -> None:
        self.socket.close()
