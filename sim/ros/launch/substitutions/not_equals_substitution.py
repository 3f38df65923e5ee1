"""The substitution that is the negation of EqualsSubstitution."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitutions.equals_substitution import EqualsSubstitution


class NotEqualsSubstitution(EqualsSubstitution):
    """`true` when EqualsSubstitution is `false`."""

    def _answer(self, context: LaunchContext) -> bool:
        return not super()._answer(context)
