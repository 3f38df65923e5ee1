"""The action that resets the environment."""

from __future__ import annotations

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext


@expose_action("reset_env")
class ResetEnvironment(Action):
    """Restores the environment that existed before the launch."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
