"""Sends service requests and responses to other processes.

Any thread may send. A ZeroMQ ROUTER socket rejects messages to a peer until the handshake after connect() is complete;
the I/O thread retries rejected messages every millisecond until their deadline.

Source: https://zguide.zeromq.org/docs/chapter3/ (ROUTER sockets)
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterable, Sequence

import zmq

from gz_course.sim.gz.transport.environment import complain

RETRY_S = 0.001
"""Period [s] at which the I/O thread retries pending messages."""
_MOST_CONNECTIONS = 256
_MOST_WAITING = 10_000
_RECONNECT_MS, _RECONNECT_MOST_MS = 20, 1000

Target = tuple[str, bytes, Sequence[bytes]]
"""The address of a process, the routing id of its socket, and the frames to send."""


class Letter:
    """A message for the first of several targets that can be reached."""

    def __init__(self, targets: Callable[[], Iterable[Target]], deadline: float, on_sent: Callable[[], None]) -> None:
        """Create a message; `targets()` is called at each attempt until `deadline` (monotonic clock [s])."""
        self.targets = targets
        self.deadline = deadline
        self.on_sent = on_sent


class Courier:
    """A ROUTER socket that connects to every target of its messages."""

    def __init__(self, context: zmq.Context[zmq.Socket[bytes]], wake: Callable[[], None]) -> None:
        """Open the socket; `wake()` makes the I/O thread call retry() soon."""
        self._wake = wake
        self._lock = threading.Lock()
        self._waiting: list[Letter] = []
        self._connected: dict[str, None] = {}  # the last entry is the most recently used address
        self._socket = context.socket(zmq.ROUTER)
        self._socket.setsockopt(zmq.ROUTER_MANDATORY, 1)
        self._socket.setsockopt(zmq.IMMEDIATE, 1)  # no queue for peers whose connection is lost
        self._socket.setsockopt(zmq.LINGER, 200)
        self._socket.setsockopt(zmq.RECONNECT_IVL, _RECONNECT_MS)
        self._socket.setsockopt(zmq.RECONNECT_IVL_MAX, _RECONNECT_MOST_MS)

    def send(self, letter: Letter) -> None:
        """Send at once, or as soon as a target can be reached."""
        if self._attempt(letter):
            letter.on_sent()
            return
        with self._lock:
            if len(self._waiting) < _MOST_WAITING:
                self._waiting.append(letter)
        self._wake()

    def retry(self) -> bool:
        """Send pending messages and drop expired ones; return whether any is still pending. I/O thread only."""
        if not self._waiting:
            return False
        with self._lock:
            letters, self._waiting = self._waiting, []
        now = time.monotonic()
        left = []
        for letter in letters:
            if self._attempt(letter):
                letter.on_sent()
            elif now < letter.deadline:
                left.append(letter)
        with self._lock:
            self._waiting = left + self._waiting
            return bool(self._waiting)

    def withdraw(self, letter: Letter) -> None:
        with self._lock, contextlib.suppress(ValueError):
            self._waiting.remove(letter)

    def _attempt(self, letter: Letter) -> bool:
        for address, routing_id, frames in letter.targets():
            with self._lock:
                if self._socket.closed or not self._connect(address):
                    continue
                try:
                    self._socket.send_multipart((routing_id, *frames), zmq.NOBLOCK)
                    return True
                except zmq.ZMQError as error:  # EHOSTUNREACH: not connected yet; EAGAIN: the queue is full
                    if error.errno not in (zmq.EHOSTUNREACH, zmq.EAGAIN):
                        complain(f"{address} cannot be reached: {error}.")
        return False

    def _connect(self, address: str) -> bool:
        if address in self._connected:
            del self._connected[address]
        else:
            try:
                self._socket.connect(address)
            except zmq.ZMQError:
                return False
            if len(self._connected) >= _MOST_CONNECTIONS:
                self._leave(next(iter(self._connected)))
        self._connected[address] = None
        return True

    def leave(self, address: str) -> None:
        """Disconnect from a process that has ended."""
        with self._lock:
            if address in self._connected and not self._socket.closed:
                self._leave(address)

    def _leave(self, address: str) -> None:
        del self._connected[address]
        with contextlib.suppress(zmq.ZMQError):
            self._socket.disconnect(address)

    def close(self) -> None:
        """Close the socket; messages in transit are still sent for a moment."""
        with self._lock:
            self._socket.close()
