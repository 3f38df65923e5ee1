"""The action that sets an environment variable."""

from __future__ import annotations

from collections.abc import MutableMapping

from gz_course.sim.launch.actions.set_variable import SetVariable
from gz_course.sim.launch.launch_context import LaunchContext


class SetEnvironmentVariable(SetVariable):
    """An action that gives an environment variable, which processes inherit, a value."""

    def _variables(self, context: LaunchContext) -> MutableMapping[str, str]:
        return context.environment
