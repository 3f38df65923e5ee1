"""The substitution that joins the components of a path."""

from __future__ import annotations

import os
from collections.abc import Iterable

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class PathJoinSubstitution(Substitution):
    """Components joined with `/`; each is text, a substitution, or a list of them that forms one component.

    `PathJoinSubstitution([...]) / "more"` adds a component.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        parts: Iterable[SomeSubstitutionsType]
        parts = [substitutions] if isinstance(substitutions, str | Substitution) else substitutions
        self.substitutions = [normalize_to_list_of_substitutions(part) for part in parts]

    def __truediv__(self, component: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, component])

    def describe(self) -> str:
        return f"PathJoin({', '.join(describe_substitutions(part) for part in self.substitutions)})"

    def perform(self, context: LaunchContext) -> str:
        return os.path.join("", *[perform_substitutions(context, part) for part in self.substitutions])  # noqa: PTH118
