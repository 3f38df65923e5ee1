"""The condition that holds when a text is false."""

from __future__ import annotations

from gz_course.sim.ros.launch.conditions.if_condition import IfCondition
from gz_course.sim.ros.launch.launch_context import LaunchContext


class UnlessCondition(IfCondition):
    """A condition that holds when the text is `false` or `0`."""

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)
