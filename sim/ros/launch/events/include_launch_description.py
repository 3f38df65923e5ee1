"""The event that includes a launch description."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_description import LaunchDescription


class IncludeLaunchDescription(Event):
    """Makes LaunchService visit a launch description."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescription) -> None:
        self.launch_description = launch_description
