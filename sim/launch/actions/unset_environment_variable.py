"""The action that removes an environment variable."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class UnsetEnvironmentVariable(Action):
    """Removes an environment variable, if it is set."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(perform_substitutions(context, self.name), None)
