"""The action that removes a launch configuration."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class UnsetLaunchConfiguration(Action):
    """Removes a launch configuration, if it is set."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)
