"""The action that ends a scope of the environment."""

from __future__ import annotations

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext


@expose_action("pop_env")
class PopEnvironment(Action):
    """Restores the environment saved by PushEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        context._pop_environment()
