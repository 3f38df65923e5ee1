"""The action that ends a scope of launch configurations."""

from __future__ import annotations

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.launch_context import LaunchContext


class PopLaunchConfigurations(Action):
    """Restores the configurations saved by PushLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_launch_configurations()
