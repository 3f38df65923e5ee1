"""What goes between a command and its helper: an order with four descriptors, and answers, a line of JSON each.

Source: unix(7), SCM_RIGHTS and SO_PEERCRED.
"""

from __future__ import annotations

import json
import os
import socket
import struct
from typing import Any

FOLDER_AND_STREAMS = 4  # descriptors of an order: the working folder, standard input, output and error
_SIZE = struct.Struct("I")
_CREDENTIALS = struct.Struct("3i")  # process, user and group
_MOST = 1 << 24  # [bytes] of an order


def is_own(connection: socket.socket) -> bool:
    """Return whether the process at the other end is this user's."""
    data = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return bool(_CREDENTIALS.unpack(data)[1] == os.geteuid())


def send_order(connection: socket.socket, arguments: list[str]) -> None:
    """Send what a grading needs of this process. Raises OSError."""
    umask = os.umask(0o077)
    os.umask(umask)
    content = json.dumps({"arguments": arguments, "environment": dict(os.environ), "umask": umask}).encode()
    folder = os.open(".", os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        socket.send_fds(connection, [_SIZE.pack(len(content))], [folder, 0, 1, 2])
        connection.sendall(content)
    finally:
        os.close(folder)


def receive_order(connection: socket.socket) -> tuple[dict[str, Any], list[int]]:
    """Return an order and its descriptors. Raises OSError or ValueError if it is none; then no descriptor is open."""
    data, descriptors, _, _ = socket.recv_fds(connection, _SIZE.size, FOLDER_AND_STREAMS)
    try:
        if len(data) < _SIZE.size or len(descriptors) != FOLDER_AND_STREAMS:
            raise ValueError("no order has come")
        (size,) = _SIZE.unpack(data)
        content = bytearray()
        while len(content) < min(size, _MOST):
            part = connection.recv(min(size, _MOST) - len(content))
            if not part:
                raise ValueError("the order has no end")
            content += part
        return json.loads(content), descriptors
    except (OSError, ValueError):
        for each in descriptors:
            os.close(each)
        raise


def send_answer(connection: socket.socket, **content: int) -> None:
    """Send one answer. Raises OSError."""
    connection.sendall(json.dumps(content).encode() + b"\n")
