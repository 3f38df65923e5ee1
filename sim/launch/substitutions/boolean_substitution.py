"""Substitutions whose text is `true` or `false`, and the choice between two texts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from gz_course.sim.launch.conditions.evaluate_condition_expression_impl import as_bool
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.launch.substitutions.substitution_failure import SubstitutionFailure


class _Boolean(Substitution):
    """Base: some operands, one answer."""

    def __init__(self, *operands: SomeSubstitutionsType) -> None:
        self._operands = [_as_substitutions(operand) for operand in operands]

    def describe(self) -> str:
        """`AndSubstitution('a', 'b')`."""
        return f"{type(self).__name__}({', '.join(describe_substitutions(each) for each in self._operands)})"

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`. Raises SubstitutionFailure when an operand is neither."""
        return str(self._answer(context)).lower()

    def _answer(self, context: LaunchContext) -> bool:
        raise NotImplementedError

    def _values(self, context: LaunchContext) -> Iterable[bool]:
        return (_performed_bool(context, operand, type(self).__name__) for operand in self._operands)


class NotSubstitution(_Boolean):
    """`true` when `value` is false."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        super().__init__(value)

    @property
    def value(self) -> list[Substitution]:
        """The operand."""
        return self._operands[0]

    def _answer(self, context: LaunchContext) -> bool:
        return not all(self._values(context))


class AllSubstitution(_Boolean):
    """`true` when all of any number of operands are."""

    def _answer(self, context: LaunchContext) -> bool:
        return all(list(self._values(context)))


class AnySubstitution(_Boolean):
    """`true` when one of any number of operands is."""

    def _answer(self, context: LaunchContext) -> bool:
        return any(list(self._values(context)))


class AndSubstitution(AllSubstitution):
    """`true` when both are."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class OrSubstitution(AnySubstitution):
    """`true` when one of the two is."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class EqualsSubstitution(_Boolean):
    """`true` when both sides are equal: as booleans, else as numbers, else as text."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)

    def _answer(self, context: LaunchContext) -> bool:
        left, right = (perform_substitutions(context, operand) for operand in self._operands)
        booleans = as_bool(left), as_bool(right)
        if None not in booleans:
            return booleans[0] == booleans[1]
        numbers = _as_number(left), _as_number(right)
        if numbers[0] is not None and numbers[1] is not None:
            return math.isclose(numbers[0], numbers[1])
        return left == right


class NotEqualsSubstitution(EqualsSubstitution):
    """`true` when EqualsSubstitution is `false`."""

    def _answer(self, context: LaunchContext) -> bool:
        return not super()._answer(context)


class IfElseSubstitution(Substitution):
    """`if_value` when the condition is true, else `else_value`; both are empty unless given."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self.__condition = _as_substitutions(condition)
        self.__values = {True: _as_substitutions(if_value), False: _as_substitutions(else_value)}

    @property
    def condition(self) -> list[Substitution]:
        """The condition."""
        return self.__condition

    @property
    def if_value(self) -> list[Substitution]:
        """The text when the condition is true."""
        return self.__values[True]

    @property
    def else_value(self) -> list[Substitution]:
        """The text when the condition is false."""
        return self.__values[False]

    def describe(self) -> str:
        """`IfElse('condition', 'a', 'b')`."""
        parts = (self.__condition, self.__values[True], self.__values[False])
        return f"IfElse({', '.join(map(describe_substitutions, parts))})"

    def perform(self, context: LaunchContext) -> str:
        """Return the text that is chosen. Raises SubstitutionFailure when the condition is no boolean."""
        return perform_substitutions(context, self.__values[_performed_bool(context, self.__condition, "IfElse")])


def _performed_bool(context: LaunchContext, substitutions: list[Substitution], what: str) -> bool:
    text = perform_substitutions(context, substitutions)
    value = as_bool(text)
    if value is None:
        raise SubstitutionFailure(f"{what}: {text!r} is neither true nor false")
    return value


def _as_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _as_substitutions(value: Any) -> list[Substitution]:
    if value is None:
        return []
    return normalize_to_list_of_substitutions(str(value) if isinstance(value, bool | int | float) else value)
