"""The condition that holds when a text is true."""

from __future__ import annotations

from gz_course.sim.ros.launch.condition import Condition
from gz_course.sim.ros.launch.conditions.evaluate_condition_expression_impl import evaluate_condition_expression
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions


class IfCondition(Condition):
    """A condition that holds when the text is `true` or `1`."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        # Python's True and False are accepted, too.
        given = str(predicate_expression) if isinstance(predicate_expression, bool) else predicate_expression
        self._expression = normalize_to_list_of_substitutions(given)
        super().__init__(predicate=self._holds)

    def _holds(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)
