"""The substitution for the value of a launch argument or launch configuration."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class LaunchConfiguration(Substitution):
    """The value of `variable_name`, else `default`; SubstitutionFailure if there is neither.

    A default of another type, such as a number, is converted with str().
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any | Iterable[Any] | None = None) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        self.__default = None if default is None else _as_substitutions(default)

    def describe(self) -> str:
        return f"LaunchConfig({' + '.join(part.describe() for part in self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value. Raises SubstitutionFailure with the nearest name."""
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            value = context.launch_configurations[name]
            return value if isinstance(value, str) else str(value)
        if self.__default is None:
            known = did_you_mean(name, context.launch_configurations, listing="these exist")
            raise SubstitutionFailure(f"launch configuration '{name}' does not exist{known}")
        return perform_substitutions(context, self.__default)


def _as_substitutions(default: Any) -> list[Substitution]:
    if isinstance(default, str | Substitution):
        return normalize_to_list_of_substitutions(default)
    if isinstance(default, Iterable):
        return normalize_to_list_of_substitutions(
            item if isinstance(item, str | Substitution) else str(item) for item in default
        )
    return normalize_to_list_of_substitutions(str(default))
