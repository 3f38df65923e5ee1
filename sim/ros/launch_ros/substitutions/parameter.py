"""The substitution for a parameter that `SetParameter` has set for the nodes of the scope."""

from __future__ import annotations

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_PARAMETERS = "global_params"


class Parameter(Substitution):
    """The value of the parameter `name` of the scope, else `default`; SubstitutionFailure if there is neither."""

    def __init__(self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.__default = None if default is None else normalize_to_list_of_substitutions(default)

    def describe(self) -> str:
        return f"Parameter(name={describe_substitutions(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value. Raises SubstitutionFailure with the nearest name."""
        name = perform_substitutions(context, self.name)
        known = {
            pair[0]: str(pair[1])
            for pair in context.launch_configurations.get(_PARAMETERS, ())
            if isinstance(pair, tuple)
        }
        if name in known:
            return known[name]
        if self.__default is None:
            hint = did_you_mean(name, known, listing="these are set")
            raise SubstitutionFailure(f"the parameter '{name}' is not set for the nodes of this scope{hint}")
        return perform_substitutions(context, self.__default)
