"""The connection of a process in the sandbox to the grader: one socket for whole messages in both directions.

Each message is JSON: `hello` first, then reports (`rclpy_7_1.py`). A thread passes the grader's messages to the
callback given to `listen`; before there is one, `receive` returns them. If the grader ends, the process goes on without
it.
"""

from __future__ import annotations

import contextlib
import json
import os
import socket
import sys
import threading
from collections.abc import Callable
from typing import Any

SOCKET = "COURSE_SOCKET"  # environment variable with the path of the grader's socket
LARGEST = 1 << 20  # [bytes] of one message
LONGEST_PATH = 100  # [bytes] that fit into a socket address on every system


class Channel:
    """A connection that sends `hello` at once; `open` is False once the other end is gone."""

    def __init__(self, path: str) -> None:
        self.open = self.listening = False
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with contextlib.suppress(OSError):
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, LARGEST)
            _connect(self._socket, path)
            self.open = True
        os.register_at_fork(after_in_child=self._leave)
        self.send({"hello": {"pid": os.getpid(), "group": os.getpgid(0), "command": sys.orig_argv[:100]}})

    def send(self, message: dict[str, Any]) -> None:
        """Send one message."""
        self.send_text(json.dumps(message))

    def send_text(self, text: str) -> None:
        """Send one message that is JSON already."""
        if self.open:
            with contextlib.suppress(OSError):
                self._socket.send(text.encode(errors="replace"))

    def listen(self, heard: Callable[[dict[str, Any] | None], object]) -> None:
        """Call `heard` in a thread with every message, and with None after the last."""

        def run() -> None:
            while (message := self.receive()) is not None:
                heard(message)
            heard(None)

        if self.open:
            self.listening = True
            threading.Thread(target=run, name="grader", daemon=True).start()
        else:
            heard(None)

    def receive(self) -> dict[str, Any] | None:
        """Wait for the next message; None after the last."""
        try:
            data = self._socket.recv(LARGEST) if self.open else b""
        except OSError:
            data = b""
        self.open &= bool(data)
        message: dict[str, Any] | None = json.loads(data) if data else None
        return message

    def _leave(self) -> None:
        """Drop the connection in a forked process: it belongs to the parent."""
        self.open = False
        with contextlib.suppress(OSError):
            self._socket.close()


def _connect(connecting: socket.socket, path: str) -> None:
    """Connect to a path of any length; the address of a socket holds about a hundred bytes. Source: unix(7)."""
    folder, _, name = path.rpartition("/")
    descriptor = os.open(folder, os.O_PATH | os.O_DIRECTORY)
    try:
        connecting.connect(f"/proc/self/fd/{descriptor}/{name}" if len(path) > LONGEST_PATH else path)
    finally:
        os.close(descriptor)


_channel: Channel | None = None


def channel() -> Channel:
    """Return the connection of this process, which is made by the first call."""
    global _channel
    if _channel is None:
        _channel = Channel(os.environ[SOCKET])
    return _channel
