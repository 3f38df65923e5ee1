"""The substitution that chooses between two texts."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.boolean_substitution import operand_substitutions, performed_bool
from gz_course.sim.ros.launch.utilities import describe_substitutions, perform_substitutions


class IfElseSubstitution(Substitution):
    """`if_value` if the condition is true, else `else_value`; both are empty by default."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self.condition = operand_substitutions(condition)
        self.if_value = operand_substitutions(if_value)
        self.else_value = operand_substitutions(else_value)

    def describe(self) -> str:
        return f"IfElse({', '.join(map(describe_substitutions, (self.condition, self.if_value, self.else_value)))})"

    def perform(self, context: LaunchContext) -> str:
        """Return the selected text. Raises SubstitutionFailure if the condition is no boolean."""
        holds = performed_bool(context, self.condition, "IfElse")
        return perform_substitutions(context, self.if_value if holds else self.else_value)
