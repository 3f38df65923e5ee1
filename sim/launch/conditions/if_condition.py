"""Conditions that read a text as true or false."""

from __future__ import annotations

from gz_course.sim.launch.condition import Condition
from gz_course.sim.launch.conditions.evaluate_condition_expression_impl import evaluate_condition_expression
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import SomeSubstitutionsType, normalize_to_list_of_substitutions


class IfCondition(Condition):
    """Holds when the text is `true` or `1`."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        expression = _as_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, expression))


class UnlessCondition(Condition):
    """Holds when the text is `false` or `0`."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        expression = _as_substitutions(predicate_expression)

        def predicate(context: LaunchContext) -> bool:
            return not evaluate_condition_expression(context, expression)

        super().__init__(predicate=predicate)


def _as_substitutions(expression: SomeSubstitutionsType) -> list:
    # A Python True or False is no substitution, but what is meant is plain.
    return normalize_to_list_of_substitutions(str(expression) if isinstance(expression, bool) else expression)
