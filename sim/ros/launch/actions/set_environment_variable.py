"""The action that sets an environment variable."""

from __future__ import annotations

from collections.abc import MutableMapping

from gz_course.sim.ros.launch.actions.set_variable import SetVariable
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext


@expose_action("set_env")
class SetEnvironmentVariable(SetVariable):
    """Sets an environment variable of this process, which child processes inherit."""

    def _variables(self, context: LaunchContext) -> MutableMapping[str, str]:
        return context.environment
