"""The sequence of `course diagnose`: observe both graphs, then judge them."""

from __future__ import annotations

import json
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.tools.diagnose.finding import Finding, Severity, findings
from gz_course.grader.tools.diagnose.system import System


@dataclass(frozen=True)
class Diagnosis:
    """The findings, worst first, and the system they were found in."""

    system: System
    findings: list[Finding]
    wall_seconds: float

    @property
    def wrong(self) -> bool:
        """Whether there is a finding worse than a note."""
        return any(finding.severity is not Severity.NOTE for finding in self.findings)

    def as_dict(self) -> dict[str, Any]:
        """Return the JSON report as plain data."""
        ros, gz = self.system.ros, self.system.gz
        return {
            "wrong": self.wrong,
            "findings": [finding.as_dict() for finding in self.findings],
            "ros": {
                "domain": ros.domain,
                "nodes": [node.name for node in ros.nodes],
                "bridges": {
                    bridge.node: [
                        {
                            "ros_topic_name": entry.ros_topic,
                            "gz_topic_name": entry.gz_topic,
                            "ros_type_name": entry.ros_type,
                            "gz_type_name": entry.gz_type,
                            "direction": entry.direction.value,
                        }
                        for entry in bridge.entries
                    ]
                    for bridge in ros.bridges
                },
            },
            "gz": {"partition": gz.partition, "worlds": [world.name for world in gz.worlds]},
            "wall_seconds": round(self.wall_seconds, 2),
        }

    def as_json(self) -> str:
        return json.dumps(self.as_dict(), indent=2) + "\n"


def diagnose(seconds: float = 2.0) -> Diagnosis:
    """Observe both graphs, listen for `seconds` [s], and judge what was observed.

    Raises InfrastructureError if ROS or Gazebo's transport cannot be used at all.
    """
    started = time.monotonic()
    system = observe(seconds)
    return Diagnosis(system, findings(system), time.monotonic() - started)


def observe(seconds: float) -> System:
    """Observe both sides at the same time. Raises InfrastructureError as `diagnose` does."""
    from gz_course.grader.tools.diagnose import gz_side, ros_side
    from gz_course.grader.tools.diagnose.distant import distant_processes
    from gz_course.grader.tools.diagnose.ended import ended_programs
    from gz_course.grader.tools.diagnose.stopped import stopped_processes
    from gz_course.sim.ros.ros2.errors import CommandError

    stop = threading.Event()
    with ThreadPoolExecutor(1, "gz-side") as pool:
        gz = pool.submit(gz_side.observe, seconds, stop)
        try:
            ros = ros_side.observe(seconds)
        except CommandError as error:
            stop.set()
            raise InfrastructureError(str(error)) from None
        except BaseException:  # after Ctrl-C nobody waits for the other side
            stop.set()
            raise
        try:
            found = gz.result()
        except OSError as error:
            raise InfrastructureError(f"Gazebo's transport cannot be used: {error}") from None
    place = (ros.domain, found.partition)
    return System(ros, found, stopped_processes(*place), distant_processes(*place), ended_programs(*place))
