"""A remapping for all nodes of a scope."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

REMAPS = "ros_remaps"


class SetRemap(Action):
    """Lets `src` be called `dst` in the nodes that follow."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__src = normalize_to_list_of_substitutions(src)
        self.__dst = normalize_to_list_of_substitutions(dst)

    @property
    def src(self) -> list[Substitution]:
        """The name in the node's code."""
        return self.__src

    @property
    def dst(self) -> list[Substitution]:
        """The name it gets."""
        return self.__dst

    def execute(self, context: LaunchContext) -> None:
        """Add it to those of the scope."""
        pair = perform_substitutions(context, self.__src), perform_substitutions(context, self.__dst)
        there = context.launch_configurations.get(REMAPS, ())
        context.launch_configurations[REMAPS] = (*there, pair)
