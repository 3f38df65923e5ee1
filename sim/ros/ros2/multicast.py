"""One UDP datagram to and from the multicast group of `ros2 multicast` and `ros2 doctor hello`.

Source: ros2multicast 0.32 (`ros2multicast/api`: group and port)
"""

from __future__ import annotations

import contextlib
import os
import socket
import struct
from collections.abc import Iterator

from gz_course.sim.ros.ros2.errors import CommandError

GROUP = "225.0.0.1"
PORT = 49150
_LARGEST = 4096  # [byte]


def send(data: bytes, ttl: int | None = None) -> None:
    """Send one datagram; it crosses at most `ttl` networks. Raises CommandError."""
    with _socket() as sender:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(_interface()))
        if ttl is not None:
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        sender.sendto(data, (GROUP, PORT))


@contextlib.contextmanager
def receiver() -> Iterator[socket.socket]:
    """Open a socket that hears the group. Raises CommandError."""
    with _socket() as heard:
        heard.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        heard.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        heard.bind(("", PORT))
        member = struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton(_interface()))
        heard.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        yield heard


def received(heard: socket.socket) -> tuple[str, str, int]:
    """Wait for one datagram; return its text, and the address and port it came from."""
    data, (host, port) = heard.recvfrom(_LARGEST)
    return data.decode(errors="replace"), host, port


@contextlib.contextmanager
def _socket() -> Iterator[socket.socket]:
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM, socket.IPPROTO_UDP) as opened:
            yield opened
    except InterruptedError:
        raise
    except OSError as error:
        if isinstance(error, BlockingIOError | TimeoutError):
            raise
        raise CommandError(
            f"Multicast to {GROUP}:{PORT} does not work here: {error.strerror}; ROS nodes of this machine find each "
            "other without it if ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST is set"
        ) from None


def _interface() -> str:
    """Return the address whose network is used: this machine's own if ROS looks no further."""
    here = os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper() in ("LOCALHOST", "OFF")
    return "127.0.0.1" if here or os.environ.get("ROS_LOCALHOST_ONLY") == "1" else "0.0.0.0"
