"""Substitutions whose text is `true` or `false`, computed from boolean operands."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.sim.ros.launch.conditions.evaluate_condition_expression_impl import as_bool
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class BooleanSubstitution(Substitution):
    """Base of substitutions that compute `true` or `false` from their operands."""

    def __init__(self, *operands: SomeSubstitutionsType) -> None:
        self._operands = [operand_substitutions(operand) for operand in operands]

    def describe(self) -> str:
        return f"{type(self).__name__}({', '.join(describe_substitutions(each) for each in self._operands)})"

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`. Raises SubstitutionFailure if an operand is neither."""
        return str(self._answer(context)).lower()

    def _answer(self, context: LaunchContext) -> bool:
        raise NotImplementedError

    def _values(self, context: LaunchContext) -> Iterable[bool]:
        return [performed_bool(context, operand, type(self).__name__) for operand in self._operands]


class NotSubstitution(BooleanSubstitution):
    """`true` if `value` is false."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        super().__init__(value)
        self.value = self._operands[0]

    def _answer(self, context: LaunchContext) -> bool:
        return not all(self._values(context))


class AllSubstitution(BooleanSubstitution):
    """`true` if all operands are true."""

    def _answer(self, context: LaunchContext) -> bool:
        return all(self._values(context))


class AnySubstitution(BooleanSubstitution):
    """`true` if at least one operand is true."""

    def _answer(self, context: LaunchContext) -> bool:
        return any(self._values(context))


class AndSubstitution(AllSubstitution):
    """`true` if both operands are true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class OrSubstitution(AnySubstitution):
    """`true` if at least one of two operands is true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


def performed_bool(context: LaunchContext, substitutions: list[Substitution], what: str) -> bool:
    """Return the performed text as a bool. Raises SubstitutionFailure if it is neither true nor false."""
    text = perform_substitutions(context, substitutions)
    value = as_bool(text)
    if value is None:
        raise SubstitutionFailure(f"{what}: {text!r} is neither true nor false")
    return value


def operand_substitutions(value: Any) -> list[Substitution]:
    """Return an operand, which may also be None or a plain Python value, as a list of substitutions."""
    if value is None:
        return []
    return normalize_to_list_of_substitutions(str(value) if isinstance(value, bool | int | float) else value)
