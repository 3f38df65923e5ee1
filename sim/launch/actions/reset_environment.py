"""The action that resets the environment."""

from __future__ import annotations

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext


class ResetEnvironment(Action):
    """An action that makes the environment what it was before the launch."""

    def execute(self, context: LaunchContext) -> None:
        context._reset_environment()
