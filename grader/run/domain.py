"""Reservation of a ROS domain for one run, so that two gradings on one machine never receive each other's messages.

The reservation is an abstract unix socket: it needs no file and disappears with the process that holds it.

Source: unix(7), "Abstract sockets".
"""

from __future__ import annotations

import os
import random
import socket
from types import TracebackType

from gz_course.grader.errors import InfrastructureError

# DDS ports are 7400 + 250 * domain + ...; above domain 101 they reach Linux's ephemeral ports (32768 and up). Domain 0
# is everybody's default and stays free. Source: DDSI-RTPS 2.2, 9.6.1.
DOMAINS = range(1, 102)
FIRST_PORT, PORTS_PER_DOMAIN = 7400, 250


class Domain:
    """A ROS domain id reserved until `release()`; also a context manager."""

    def __init__(self) -> None:
        self._lock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        order = list(DOMAINS)
        random.Random(os.getpid()).shuffle(order)
        # Others who speak in a domain would be taken for the submission where the network is shared.
        for candidate in sorted(order, key=_is_in_use):
            try:
                self._lock.bind(f"\0gz-ros2-course-domain-{candidate}")
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


def _is_in_use(domain: int) -> bool:
    """Whether a participant listens for others in a domain, in the network this process is in."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", FIRST_PORT + PORTS_PER_DOMAIN * domain))
        except OSError:
            return True
    return False
