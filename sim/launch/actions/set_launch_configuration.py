"""Actions on launch configurations: set and unset one, push, pop and reset them all."""

from __future__ import annotations

from collections.abc import Mapping
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


class SetLaunchConfiguration(Action):
    """Gives a launch configuration a value."""

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
        return f"SetLaunchConfiguration({describe_substitutions(self.__name)}, {describe_substitutions(self.__value)})"

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        name = perform_substitutions(context, self.__name)
        context.launch_configurations[name] = perform_substitutions(context, self.__value)


class UnsetLaunchConfiguration(Action):
    """Takes a launch configuration away; nothing happens when there is none of that name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.launch_configurations.pop(perform_substitutions(context, self.__name), None)


class PushLaunchConfigurations(Action):
    """Begins a scope: what is set from now on is forgotten at PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        """Begin the scope."""
        context._push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Ends the scope that PushLaunchConfigurations began."""

    def execute(self, context: LaunchContext) -> None:
        """End the scope."""
        context._pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Takes all launch configurations away, except for those given."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    def execute(self, context: LaunchContext) -> None:
        """Perform the values that are kept, then reset."""
        kept = {perform_substitutions(context, name): perform_substitutions(context, v) for name, v in self.__kept}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
