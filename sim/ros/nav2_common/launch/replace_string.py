"""A copy of a text file in which words are replaced.

Source: ros-navigation/navigation2 (jazzy), nav2_common/nav2_common/launch/replace_string.py
"""

from __future__ import annotations

from gz_course.sim.ros.launch.condition import Condition
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import perform_substitutions
from gz_course.sim.ros.nav2_common.launch.source_file import OfSourceFile, as_texts, performed, written


class ReplaceString(OfSourceFile):
    """The path of a copy of `source_file` with each text of `replacements` exchanged for its value.

    If `condition` does not hold, it is the path of the file itself.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: dict[str, SomeSubstitutionsType],
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self.condition = condition
        self._replacements = as_texts(replacements)

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure if the file cannot be read."""
        if self.condition is not None and not self.condition.evaluate(context):
            return perform_substitutions(context, self.name)
        text = self._text(context)
        for old, new in performed(context, self._replacements).items():
            text = text.replace(old, new)
        return written(text)
