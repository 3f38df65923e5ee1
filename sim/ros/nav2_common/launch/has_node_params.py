"""Whether a parameter file has parameters of a node."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.nav2_common.launch.source_file import OfSourceFile


class HasNodeParams(OfSourceFile):
    """`True` if `node_name` is a key at the top of `source_file`, otherwise `False`."""

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self._node_name = node_name

    def perform(self, context: LaunchContext) -> str:
        """Return `True` or `False`. Raises SubstitutionFailure if the file cannot be read."""
        return str(self._node_name in self._parameters(context))
