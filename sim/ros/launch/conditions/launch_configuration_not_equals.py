"""The condition that holds when a launch configuration does not have a value."""

from __future__ import annotations

from gz_course.sim.ros.launch.conditions.launch_configuration_equals import LaunchConfigurationEquals
from gz_course.sim.ros.launch.launch_context import LaunchContext


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if LaunchConfigurationEquals does not."""

    def _equals(self, context: LaunchContext) -> bool:
        return not super()._equals(context)
