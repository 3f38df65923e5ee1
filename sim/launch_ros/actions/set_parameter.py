"""Parameters for all nodes of a scope."""

from __future__ import annotations

import os
from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.launch_ros.parameter_descriptions import Parameter

# Name -> value pairs and paths of files, in the order they were set. A tuple: scopes must not share a list.
PARAMETERS = "global_params"


class SetParameter(Action):
    """Gives a parameter of the nodes that follow a value; a node's own `parameters` win."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__parameter = Parameter(name, value)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__parameter.name

    @property
    def value(self) -> Any:
        """The value."""
        return self.__parameter.value

    def execute(self, context: LaunchContext) -> None:
        """Add it to those of the scope."""
        there = context.launch_configurations.get(PARAMETERS, ())
        context.launch_configurations[PARAMETERS] = (*there, self.__parameter.evaluate(context))


class SetUseSimTime(SetParameter):
    """Lets the nodes that follow take the time from /clock, or not: their parameter use_sim_time."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)


class SetParametersFromFile(Action):
    """Gives the nodes that follow a parameter file; a node's own `parameters` win."""

    def __init__(self, filename: SomeSubstitutionsType | os.PathLike[str], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__filename = normalize_to_list_of_substitutions(filename)

    @property
    def filename(self) -> list[Substitution]:
        """The path."""
        return self.__filename

    def execute(self, context: LaunchContext) -> None:
        """Add it to those of the scope."""
        there = context.launch_configurations.get(PARAMETERS, ())
        path = perform_substitutions(context, self.__filename)
        context.launch_configurations[PARAMETERS] = (*there, path)
