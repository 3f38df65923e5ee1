"""An argument of a launch file, given as `name:=value` or by the file that includes it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import gz_course.sim.launch.logging as launch_logging
from gz_course.sim.launch.action import Action
from gz_course.sim.launch.errors import InvalidArgumentError, MissingArgumentError, nearest
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.substitution import Substitution
from gz_course.sim.launch.substitutions import TextSubstitution
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class DeclareLaunchArgument(Action):
    """Declares the argument `name`, whose value is then the launch configuration of that name.

    Without `default_value` it must be given. With `choices` its value must be one of them; a default that is plain
    text is checked at once (InvalidArgumentError).
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__name = name
        self.__default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.__choices = None if choices is None else list(choices)
        if self.__choices is not None and not self.__choices:
            raise ValueError(f"the list of choices of the argument '{name}' is empty")
        self.__description = self._description_with_choices(description)
        self._conditionally_included = False
        if self.__default_value is not None and all(isinstance(p, TextSubstitution) for p in self.__default_value):
            default = "".join(p.text for p in self.__default_value if isinstance(p, TextSubstitution))
            if self.__choices is not None and default not in self.__choices:
                raise InvalidArgumentError(
                    f'Argument "{name}" has the default value "{default}", which is not one of its choices: '
                    f"{self.__choices}"
                )

    @property
    def name(self) -> str:
        """The name."""
        return self.__name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The value when none is given; None when one must be given."""
        return self.__default_value

    @property
    def description(self) -> str:
        """What `ros2 launch --show-args` says about it."""
        return self.__description

    @property
    def choices(self) -> list[str] | None:
        """The values it may have; None for any."""
        return self.__choices

    def describe(self) -> str:
        """Return one line for `ros2 launch --print`."""
        return f"DeclareLaunchArgument('{self.__name}')"

    def execute(self, context: LaunchContext) -> None:
        """Keep the value that was given, else set the default.

        Raises MissingArgumentError when there is neither, InvalidArgumentError for a value that is no choice.
        """
        configurations = context.launch_configurations
        if self.__name not in configurations:
            if self.__default_value is None:
                known = "" if not self.__description else f" ({self.__description})"
                raise MissingArgumentError(
                    f'Required launch argument "{self.__name}" was not provided.{known} '
                    f"Give it as {self.__name}:=<value>."
                )
            configurations[self.__name] = perform_substitutions(context, self.__default_value)
        value = configurations[self.__name]
        if self.__choices is not None and value not in self.__choices:
            sentence = (
                f'Argument "{self.__name}" provided value "{value}" is not valid. Valid options are: {self.__choices}'
            )
            hint = nearest(str(value), self.__choices)
            launch_logging.get_logger("launch").error(sentence)
            raise InvalidArgumentError(sentence + (hint if "did you mean" in hint else ""))

    def _description_with_choices(self, description: str | None) -> str:
        text = "no description given" if description is None else description
        if self.__choices is None:
            return text
        if description is None:
            return f"One of: {self.__choices}"
        return f"{text}{'' if text.endswith('.') else '.'} Valid choices are: {self.__choices}"
