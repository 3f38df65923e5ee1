"""The action that visits other actions after a delay in ROS time."""

from __future__ import annotations

from collections.abc import Callable

from gz_course.sim.ros.launch.actions.timer_action import TimerAction
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch_ros.ros_adapters import get_ros_node


@expose_action("ros_timer")
class ROSTimer(TimerAction):
    """Visits `actions` once, `period` [s] of ROS time after its execution.

    ROS time is that of /clock if SetUseSimTime(True) stands before the first action that needs a ROS node.
    """

    def _call_later(self, context: LaunchContext, period: float, call: Callable[[], None]) -> Callable[[], None]:
        def due() -> None:
            timer.cancel()
            call()

        timer = get_ros_node(context).create_timer(period, due)

        def cancel() -> None:
            timer.cancel()

        return cancel


RosTimer = ROSTimer  # its name before Jazzy
