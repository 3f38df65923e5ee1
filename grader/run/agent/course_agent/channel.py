"""The way from a process in the box to the grader: one socket, on which whole messages go both ways.

Each message is JSON: `hello` first, then reports (`rclpy_7_1.py`). What the grader says is handed, in a thread of
its own, to whoever has asked to `listen`. A grader that is gone is no error: the process goes on like any other.
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

SOCKET = "COURSE_SOCKET"  # names the environment variable with the path of the grader's socket
LARGEST = 1 << 20  # [bytes] of one message
LONGEST_PATH = 100  # [bytes] that surely fit into an address


class Channel:
    """A connection that says hello at once; `open` is False when there is nobody (any more) at the other end."""

    def __init__(self, path: str) -> None:
        self.open = False
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
        """Call `heard` in a thread with every message, and with None when there will be no more."""

        def run() -> None:
            while True:
                try:
                    data = self._socket.recv(LARGEST)
                except OSError:
                    data = b""
                if not data:
                    break
                heard(json.loads(data))
            self.open = False
            heard(None)

        if self.open:
            threading.Thread(target=run, name="grader", daemon=True).start()
        else:
            heard(None)

    def _leave(self) -> None:
        """In a forked process: the connection is its parent's."""
        self.open = False
        with contextlib.suppress(OSError):
            self._socket.close()


def _connect(connecting: socket.socket, path: str) -> None:
    """Connect to a path of any length; the address of a socket holds about a hundred bytes."""
    folder, _, name = path.rpartition("/")
    descriptor = os.open(folder, os.O_PATH | os.O_DIRECTORY)
    try:
        connecting.connect(f"/proc/self/fd/{descriptor}/{name}" if len(path) > LONGEST_PATH else path)
    finally:
        os.close(descriptor)


_channel: Channel | None = None


def channel() -> Channel:
    """Return the connection of this process; it is made when first asked for."""
    global _channel
    if _channel is None:
        _channel = Channel(os.environ[SOCKET])
    return _channel
