"""Reservation of a ROS domain for one run, so that two gradings on one machine never receive each other's messages.

The reservation is an abstract unix socket: it needs no file and disappears with the process that holds it. Others, such
as a bridge in some terminal, reserve nothing; a domain in which they listen is taken last.

Source: unix(7), "Abstract sockets"; Linux, Documentation/networking/proc_net_tcp.rst (udp has the same columns).
"""

from __future__ import annotations

import os
import random
import socket
from pathlib import Path
from types import TracebackType

from gz_course.grader.errors import InfrastructureError

# DDS ports are 7400 + 250 * domain + ...; above domain 101 they reach Linux's ephemeral ports (32768 and up). Domain 0
# is everybody's default and stays free. Source: DDSI-RTPS 2.2, 9.6.1.
DOMAINS = range(1, 102)
FIRST_PORT, PORTS_PER_DOMAIN = 7400, 250
RESERVED_AS = "gz-ros2-course-domain"  # The abstract socket's name, before the number.


class Domain:
    """A ROS domain id reserved until `release()`; also a context manager."""

    def __init__(self) -> None:
        self._lock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        order = list(DOMAINS)
        random.Random(os.getpid()).shuffle(order)
        # Others who speak in a domain would be taken for the submission where the network is shared.
        for candidate in sorted(order, key=_domains_in_use().__contains__):
            try:
                self._lock.bind(f"\0{RESERVED_AS}-{candidate}")
            except OSError:
                continue
            self.id = candidate
            return
        self._lock.close()
        raise InfrastructureError(
            f"all ROS domains from {DOMAINS.start} to {DOMAINS.stop - 1} are taken by other gradings; "
            "wait for some to end"
        )

    def release(self) -> None:
        self._lock.close()

    def __enter__(self) -> Domain:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()


def _domains_in_use() -> set[int]:
    """Return the domains in which a participant listens, in the network this process is in.

    The first port of a domain is for multicast, which nobody uses who looks for others on this machine only; each
    participant has two more ports of its own.
    """
    ports = {port for table in ("udp", "udp6") for port in _bound_ports(Path("/proc/thread-self/net", table))}
    return {(port - FIRST_PORT) // PORTS_PER_DOMAIN for port in ports if port >= FIRST_PORT}


def _bound_ports(table: Path) -> list[int]:
    """Return the local ports in one of the kernel's tables of sockets; none if it has no such table."""
    try:
        rows = table.read_text().splitlines()[1:]
    except OSError:
        return []
    return [int(row.split()[1].rpartition(":")[2], 16) for row in rows]
