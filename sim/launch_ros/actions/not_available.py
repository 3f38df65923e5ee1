"""The base class of actions that a launch file may contain but that cannot be executed here.

Many launch files import them for a case that is off by default. They require programs of a full ROS 2 (rclcpp
components, the lifecycle manager); executing them raises an error that says so.
"""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.errors import NotAvailableError
from gz_course.sim.launch.launch_context import LaunchContext


class NotAvailable(Action):
    """Stores its arguments as `arguments`; execution raises NotAvailableError."""

    _instead = "start its nodes with Node(package=..., executable=...)"

    def __init__(self, *, condition: Any = None, **arguments: Any) -> None:
        super().__init__(condition=condition)
        self.arguments = arguments

    def describe(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.arguments.items())})"

    def execute(self, context: LaunchContext) -> None:
        raise NotAvailableError(
            f"{type(self).__name__} needs a full ROS 2 installation and cannot be executed here; {self._instead}, or "
            "switch it off with its condition"
        )
