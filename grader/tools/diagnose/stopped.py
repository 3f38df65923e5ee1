"""Processes of the system that are stopped (Ctrl-Z): they are silent in both graphs and hold ports.

`live.observe` looks for them, `looks/stopped_process.py` reports them.
"""

from __future__ import annotations

import contextlib

import psutil

from gz_course.grader.tools.diagnose.system import StoppedProcess
from gz_course.sim.gz.transport.environment import NetworkSettings, default_partition

_FIRST_PORT, _PORTS_PER_DOMAIN = 7400, 250  # Source: DDSI-RTPS 2.2, 9.6.1


def stopped_processes(domain: int, partition: str) -> list[StoppedProcess]:
    """Return stopped processes of this user that have joined the ROS domain or the Gazebo partition."""
    first = _FIRST_PORT + _PORTS_PER_DOMAIN * domain
    ros, gz = range(first, first + _PORTS_PER_DOMAIN), NetworkSettings.from_environment().message_port
    found = []
    for process in psutil.process_iter(["status"]):
        if process.info["status"] != psutil.STATUS_STOPPED:
            continue
        with contextlib.suppress(psutil.Error, OSError):  # it has ended meanwhile, or belongs to another user
            ports = {each.laddr.port for each in process.net_connections("udp") if each.laddr}
            in_partition = gz in ports and default_partition(process.environ()) == partition
            if in_partition or any(port in ros for port in ports):
                found.append(StoppedProcess(process.pid, " ".join(process.cmdline())))
    return found
