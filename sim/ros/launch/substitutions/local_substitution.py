"""The substitution for a part of `context.locals`."""

from __future__ import annotations

from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure


class LocalSubstitution(Substitution):
    """A value of `context.locals`, for example `event.returncode` in the actions of an event handler."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.__description = description

    def describe(self) -> str:
        return f"LocalVar('{self.__description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """Return the value as text. Raises SubstitutionFailure if it does not exist."""
        name, *attributes = self.expression.split(".")
        value = local_value(context, name, f"there is no '{name}' in the launch file's locals")
        for attribute in attributes:
            if not hasattr(value, attribute):
                known = did_you_mean(
                    attribute, [each for each in dir(value) if not each.startswith("_")], listing="there are"
                )
                raise SubstitutionFailure(f"{type(value).__name__} has no '{attribute}'{known}")
            value = getattr(value, attribute)
        return str(value)


def local_value(context: LaunchContext, name: str, otherwise: str) -> Any:
    """Return a value of `context.locals`. Raises SubstitutionFailure with the sentence `otherwise`."""
    known = context.get_locals_as_dict()
    if name not in known:
        raise SubstitutionFailure(otherwise)
    return known[name]
