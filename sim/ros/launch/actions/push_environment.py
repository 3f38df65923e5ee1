"""The action that begins a scope of the environment."""

from __future__ import annotations

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext


@expose_action("push_env")
class PushEnvironment(Action):
    """Saves the environment for PopEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._push_environment()
