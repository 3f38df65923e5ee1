"""The action that begins a scope of launch configurations."""

from __future__ import annotations

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.launch_context import LaunchContext


class PushLaunchConfigurations(Action):
    """Saves the launch configurations for PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._push_launch_configurations()
