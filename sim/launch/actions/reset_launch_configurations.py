"""The action that removes launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class ResetLaunchConfigurations(Action):
    """Removes all launch configurations and sets the given ones."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    def execute(self, context: LaunchContext) -> None:
        """Evaluate the new values before removing the configurations, to which they may refer."""
        kept = {perform_substitutions(context, name): perform_substitutions(context, v) for name, v in self.__kept}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
