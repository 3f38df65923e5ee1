"""Processes that belong to the same Gazebo partition but to another ROS domain, so that they hear nothing from here.

A DDS participant has two unicast ports that follow from its domain and its number. `live.observe` looks for them,
`looks/other_domain.py` reports them.

Source: DDSI-RTPS 2.2, 9.6.1.1, https://www.omg.org/spec/DDSI-RTPS/2.2
"""

from __future__ import annotations

import contextlib
import os

import psutil

from gz_course.grader.tools.diagnose.system import DistantProcess
from gz_course.sim.gz.transport.environment import default_partition

_FIRST_PORT, _PORTS_PER_DOMAIN, _DOMAINS = 7400, 250, 233
_FIRST_UNICAST = 10


def distant_processes(domain: int, partition: str) -> list[DistantProcess]:
    """Return the processes of this user with a participant in another domain than `domain` only."""
    ports: dict[int, set[int]] = {}
    with contextlib.suppress(psutil.Error, OSError):
        for each in psutil.net_connections("udp"):
            if each.pid is not None and each.laddr:
                ports.setdefault(each.pid, set()).add(each.laddr.port)
    found = []
    for pid, bound in sorted(ports.items()):
        domains = domains_of(bound)
        if not domains or domain in domains or pid == os.getpid():
            continue
        with contextlib.suppress(psutil.Error, OSError):  # it has ended meanwhile, or belongs to another user
            process = psutil.Process(pid)
            if process.uids().real == os.getuid() and default_partition(process.environ()) == partition:
                found.append(DistantProcess(pid, " ".join(process.cmdline()), min(domains)))
    return found


def domains_of(ports: set[int]) -> set[int]:
    """Return the ROS domains whose pairs of unicast ports are among the ports of a process."""
    domains = set()
    for port in ports:
        domain, offset = divmod(port - _FIRST_PORT, _PORTS_PER_DOMAIN)
        is_first = offset >= _FIRST_UNICAST and offset % 2 == 0
        if 0 <= domain < _DOMAINS and is_first and port + 1 in ports:
            domains.add(domain)
    return domains
