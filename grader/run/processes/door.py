"""The socket at which the processes of a sandbox connect to the grader."""

from __future__ import annotations

import os
import socket
from pathlib import Path

SOCKET = "participants"  # file name
MOST_PARTICIPANTS = 100  # processes that are followed
AGENT = Path(__file__).parents[1] / "agent"  # runs in the submission's processes; has the same path in the sandbox


def listener(folder: Path) -> socket.socket:
    """Return a listening socket in a folder, which may have a long path."""
    door = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    (folder / SOCKET).unlink(missing_ok=True)
    descriptor = os.open(folder, os.O_PATH | os.O_DIRECTORY)
    try:
        door.bind(f"/proc/self/fd/{descriptor}/{SOCKET}")
    finally:
        os.close(descriptor)
    (folder / SOCKET).chmod(0o666)  # the sandbox may have a user of its own
    door.listen(MOST_PARTICIPANTS)
    door.setblocking(False)
    return door
