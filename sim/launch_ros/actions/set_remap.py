"""The action that remaps a name of all nodes of a scope."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

REMAPS = "ros_remaps"


class SetRemap(Action):
    """Remaps the name `src` to `dst` in the following nodes."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        there = context.launch_configurations.get(REMAPS, ())
        context.launch_configurations[REMAPS] = (*there, pair)
