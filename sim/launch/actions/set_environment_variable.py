"""Actions on the environment that processes inherit: set, append and unset a variable, push, pop and reset it all."""

from __future__ import annotations

import os
from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class SetEnvironmentVariable(Action):
    """Gives an environment variable a value."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)
        self.__value = normalize_to_list_of_substitutions(value)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    @property
    def value(self) -> list[Substitution]:
        """The value."""
        return self.__value

    def describe(self) -> str:
        """Return one line for `ros2 launch --print`."""
        return f"{type(self).__name__}({describe_substitutions(self.__name)}, {describe_substitutions(self.__value)})"

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        name = perform_substitutions(context, self.__name)
        context.environment[name] = perform_substitutions(context, self.__value)


class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Adds a value behind what a variable has, or before it with `prepend`; between the two stands `separator`."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.__prepend = normalize_to_list_of_substitutions(str(prepend) if isinstance(prepend, bool) else prepend)
        self.__separator = normalize_to_list_of_substitutions(separator)

    @property
    def prepend(self) -> list[Substitution]:
        """Whether the value goes before what is there."""
        return self.__prepend

    @property
    def separator(self) -> list[Substitution]:
        """What stands between the two."""
        return self.__separator

    def execute(self, context: LaunchContext) -> None:
        """Add it."""
        from gz_course.sim.launch.conditions import evaluate_condition_expression

        name = perform_substitutions(context, self.name)
        value = perform_substitutions(context, self.value)
        there = context.environment.get(name)
        if there is not None:
            parts = [there, value]
            if evaluate_condition_expression(context, self.__prepend):
                parts.reverse()
            value = perform_substitutions(context, self.__separator).join(parts)
        context.environment[name] = value


class UnsetEnvironmentVariable(Action):
    """Takes an environment variable away; nothing happens when it is not set."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.environment.pop(perform_substitutions(context, self.__name), None)


class PushEnvironment(Action):
    """Begins a scope: what is set from now on is forgotten at PopEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        """Begin the scope."""
        context._push_environment()


class PopEnvironment(Action):
    """Ends the scope that PushEnvironment began."""

    def execute(self, context: LaunchContext) -> None:
        """End the scope."""
        context._pop_environment()


class ResetEnvironment(Action):
    """Makes the environment what it was before the launch."""

    def execute(self, context: LaunchContext) -> None:
        """Reset it."""
        context._reset_environment()
