"""A private network for a grading: only a loopback, shared by the grader's ROS nodes and the submission's.

`Sandbox` enters it before anything of ROS is loaded; threads and processes started afterwards live in that network,
while sockets opened before stay where they were. Root enters it with one thread and can return; an ordinary user needs
a user namespace, which Linux grants only to a process with a single thread, and cannot return.

Source: network_namespaces(7), user_namespaces(7), setns(2).
"""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import os
import socket
import struct
from pathlib import Path

CLONE_NEWUSER = 0x10000000
CLONE_NEWNET = 0x40000000
SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP = 0x8913, 0x8914, 0x1
_THREAD_NETWORK = "/proc/thread-self/ns/net"

# Environment variable that is set in a private network entered for good, also for child processes.
_ENTERED = "COURSE_PRIVATE_NETWORK"


class NetworkError(Exception):
    """Linux does not give this process a private network; the text says why."""


def in_private_network() -> bool:
    """Return whether this process has entered a private network for good, or was started in one."""
    return os.environ.get(_ENTERED) == str(Path(_THREAD_NETWORK).readlink())


class PrivateNetwork:
    """A private network, entered on creation and left with `close()` where possible. Raises NetworkError."""

    def __init__(self) -> None:
        self._before: int | None = None
        if in_private_network():
            return
        if os.geteuid() == 0:
            before = os.open(_THREAD_NETWORK, os.O_RDONLY | os.O_CLOEXEC)
            try:
                _unshare(CLONE_NEWNET)
            except NetworkError:
                os.close(before)
                raise
            self._before = before
        else:
            _enter_for_good()
        try:
            _loopback_up()
        except OSError as error:
            self.close()
            raise NetworkError(f"its loopback stays down: {error.strerror}") from None

    def close(self) -> None:
        """Return to the former network if this process is root; sockets opened meanwhile stay in the private one."""
        if self._before is not None:
            before, self._before = self._before, None
            try:
                if ctypes.CDLL(None, use_errno=True).setns(before, CLONE_NEWNET):
                    raise NetworkError(f"no way back from a private network: {os.strerror(ctypes.get_errno())}")
            finally:
                os.close(before)


def _unshare(flags: int) -> None:
    if ctypes.CDLL(None, use_errno=True).unshare(flags):
        number = ctypes.get_errno()
        raise NetworkError(f"unshare: {os.strerror(number)}")


def _enter_for_good() -> None:
    threads = len(list(Path("/proc/self/task").iterdir()))
    if threads > 1:
        raise NetworkError(f"this process has {threads} threads already, and an ordinary user may enter with one only")
    user, group = os.geteuid(), os.getegid()
    _unshare(CLONE_NEWUSER | CLONE_NEWNET)
    os.environ[_ENTERED] = str(Path(_THREAD_NETWORK).readlink())
    try:
        with contextlib.suppress(FileNotFoundError):
            Path("/proc/self/setgroups").write_text("deny")
        Path("/proc/self/uid_map").write_text(f"{user} {user} 1")
        Path("/proc/self/gid_map").write_text(f"{group} {group} 1")
    except OSError as error:
        raise NetworkError(f"no identity in a user namespace: {error.strerror}") from None


def _loopback_up() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as some:
        request = struct.pack("16sh14x", b"lo", 0)
        flags = struct.unpack("16sh14x", fcntl.ioctl(some, SIOCGIFFLAGS, request))[1]
        fcntl.ioctl(some, SIOCSIFFLAGS, struct.pack("16sh14x", b"lo", flags | IFF_UP))
