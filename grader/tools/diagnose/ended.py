"""Programs of the system that ended at their start, because their arguments or their file could not be used.

They leave no node, but a log file (`ros_program.last_words`). `live.observe` looks for it, `looks/ended_program.py`
reports it.
"""

from __future__ import annotations

from pathlib import Path

from rclpy.logging import get_logging_directory

from gz_course.sim.ros.ros_program.last_words import LastWords, found

_PROGRAMS = ("parameter_bridge", "image_bridge", "robot_state_publisher", "static_transform_publisher")


def ended_programs(domain: int, partition: str) -> list[LastWords]:
    """Return the last words of each program that ended in this domain and partition."""
    words = found(Path(get_logging_directory()))
    latest = {each.place: each for each in words if (each.domain, each.partition) == (domain, partition)}
    return [each for each in latest.values() if each.program in _PROGRAMS]
