"""Which descriptors this process holds, but for those that the threads of Fast DDS and ZeroMQ open when they like.

Earlier tests leave contexts of theirs in the same process. What the grader opens are files, pipes, selectors and
sockets of the Unix family; the network's sockets and their wake-up descriptors are not its own.
"""

import os
import socket
import threading
import time


def own_descriptors() -> dict[int, str]:
    """Return what each open descriptor stands for, without the network's sockets and without eventfds."""
    found = {}
    for name in os.listdir("/proc/self/fd"):  # noqa: PTH208
        try:
            what = os.readlink(f"/proc/self/fd/{name}")  # noqa: PTH115
            if what.startswith("socket:"):
                with socket.socket(fileno=os.dup(int(name))) as end:
                    family = end.family
                if family != socket.AF_UNIX:
                    continue
        except OSError:
            continue  # the listing's own, or closed meanwhile
        if what != "anon_inode:[eventfd]":
            found[int(name)] = what
    return found


def left_open(before: dict[int, str], deadline: float = 20.0) -> dict[int, str]:
    """Return what has been opened since `before` and stays open: another thread may be reading a file just now."""
    end, pause = time.monotonic() + deadline, threading.Event()
    while (left := dict(own_descriptors().items() - before.items())) and time.monotonic() < end:
        pause.wait(0.05)
    return left
