"""Converts text to a boolean, for conditions, boolean substitutions and boolean launch arguments."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext

VALID_TRUE_EXPRESSIONS = ["true", "1"]
VALID_FALSE_EXPRESSIONS = ["false", "0"]


class InvalidConditionExpressionError(LaunchError):
    """Text that is neither true nor false."""


def evaluate_condition_expression(context: LaunchContext, expression: Sequence[Substitution]) -> bool:
    """Return the performed expression as a bool. Raises InvalidConditionExpressionError."""
    text = perform_substitutions(context, expression)
    value = as_bool(text)
    if value is None:
        raise InvalidConditionExpressionError(
            f"invalid condition expression: {text!r}; true, false, 1 or 0 is expected"
        )
    return value


def as_bool(text: str) -> bool | None:
    """Return the boolean for a text in upper or lower case; None if it is neither true nor false."""
    word = text.strip().lower()
    if word in VALID_TRUE_EXPRESSIONS:
        return True
    return False if word in VALID_FALSE_EXPRESSIONS else None
