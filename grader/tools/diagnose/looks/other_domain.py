"""A node in another ROS domain: a terminal in which ROS_DOMAIN_ID was set, or was not."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

_MOST_SHOWN = 5


def look(system: System) -> Iterator[Finding]:
    """Find the processes of each other domain."""
    for domain in sorted({process.domain for process in system.distant}):
        here = [process for process in system.distant if process.domain == domain]
        who = f"The process {here[0].pid} is" if len(here) == 1 else f"{len(here)} processes are"
        yield Finding(
            Severity.WARNING,
            f"{who} in ROS domain {domain}, this terminal is in {system.ros.domain}: "
            "nodes of different domains do not hear each other.",
            f"Set the same ROS_DOMAIN_ID in every terminal (export ROS_DOMAIN_ID={system.ros.domain}), "
            "then start them again.",
            tuple(f"{process.pid}: {process.command}" for process in here[:_MOST_SHOWN]),
        )
