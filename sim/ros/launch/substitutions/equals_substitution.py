"""The substitution that compares two texts."""

from __future__ import annotations

import math
from typing import Any

from gz_course.sim.ros.launch.conditions.evaluate_condition_expression_impl import as_bool
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitutions.boolean_substitution import BooleanSubstitution
from gz_course.sim.ros.launch.utilities import perform_substitutions


class EqualsSubstitution(BooleanSubstitution):
    """`true` if both sides are equal: as booleans, else as numbers, else as text."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)

    def _answer(self, context: LaunchContext) -> bool:
        left, right = (perform_substitutions(context, operand) for operand in self._operands)
        booleans = as_bool(left), as_bool(right)
        if None not in booleans:
            return booleans[0] == booleans[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right
