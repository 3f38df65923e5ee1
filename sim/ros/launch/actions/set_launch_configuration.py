"""The action that sets a launch configuration."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from gz_course.sim.ros.launch.actions.set_variable import SetVariable
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext


@expose_action("let")
class SetLaunchConfiguration(SetVariable):
    """Sets the value of a launch configuration."""

    def _variables(self, context: LaunchContext) -> MutableMapping[str, Any]:
        return context.launch_configurations
