"""The substitution for the value of an environment variable in the launch."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class EnvironmentVariable(Substitution):
    """The value of `name`, else `default_value`; SubstitutionFailure if there is neither."""

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    def describe(self) -> str:
        return f"EnvVar({' + '.join(part.describe() for part in self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value. Raises SubstitutionFailure."""
        name = perform_substitutions(context, self.name)
        value = context.environment.get(name)
        if value is None and self.default_value is not None:
            value = perform_substitutions(context, self.default_value)
        if value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return value
