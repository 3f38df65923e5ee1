"""The base class of substitutions for a path, to which `/` adds components."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.substitution import Substitution

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
    from gz_course.sim.ros.launch.substitutions.path_join_substitution import PathJoinSubstitution


class Divisible(Substitution):
    """A path; `/` adds a component to it. Source: ros2/launch, release 3.4.9 (pull request 918)"""

    def __truediv__(self, component: SomeSubstitutionsType) -> PathJoinSubstitution:
        from gz_course.sim.ros.launch.substitutions.path_join_substitution import PathJoinSubstitution

        return PathJoinSubstitution([self, component])
