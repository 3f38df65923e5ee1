"""What an exercise's own node uses in its sandbox: its orders, and its reports to the grader.

Both go through a pair of sockets that only the grader and this process have. Unlike a pipe, nobody can open it again
through /proc; unlike a topic, nobody else can write to it. Orders stand in no command line and in no environment.

A `given_node.py` calls `orders()` once, `ready()` when its node is complete, and `report(...)` with each fact.
"""

from __future__ import annotations

import json
import os
import socket
from functools import cache
from typing import Any

LINK = "COURSE_LINK"  # environment variable with the number of the socket
READY = b"ready"
LARGEST = 1 << 20  # [bytes] of one message


@cache
def _link() -> socket.socket:
    link = socket.socket(fileno=int(os.environ.pop(LINK)))
    link.set_inheritable(False)
    link.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, LARGEST)
    return link


def orders() -> dict[str, Any]:
    """Return the table `client` of the trial's parameters."""
    found: dict[str, Any] = json.loads(_link().recv(LARGEST))
    return found


def ready() -> None:
    """Say that the submission may start."""
    _link().send(READY)


def report(**fact: Any) -> None:
    """Put a fact into the recording, at the simulated time of now."""
    _link().send(json.dumps(fact).encode())
