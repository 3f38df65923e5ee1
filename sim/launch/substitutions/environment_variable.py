"""The value of an environment variable, as children of the launch file would see it."""

from __future__ import annotations

from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.substitution import Substitution
from gz_course.sim.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class EnvironmentVariable(Substitution):
    """The value of `name`, else `default_value`; SubstitutionFailure when there is neither."""

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The value of a variable that is not set, if one was given."""
        return self.__default

    def describe(self) -> str:
        """`EnvVar('NAME')`."""
        return f"EnvVar({' + '.join(part.describe() for part in self.__name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value. Raises SubstitutionFailure."""
        name = perform_substitutions(context, self.__name)
        value = context.environment.get(name)
        if value is None and self.__default is not None:
            value = perform_substitutions(context, self.__default)
        if value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return value
