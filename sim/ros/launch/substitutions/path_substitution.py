"""The substitution for a path to which `/` adds components."""

from __future__ import annotations

from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitutions.path_join_substitution import PathJoinSubstitution


class PathSubstitution(PathJoinSubstitution):
    """A path to which components are added with `/`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])
