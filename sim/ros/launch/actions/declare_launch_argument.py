"""The action that declares an argument, passed as `name:=value` or by an including file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.errors import InvalidArgumentError, MissingArgumentError
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitutions import TextSubstitution
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """Declares the argument `name`, whose value becomes the launch configuration of that name.

    Without `default_value` the argument is required. With `choices` its value must be one of them; a default that is
    plain text is checked at once (InvalidArgumentError).
    """

    declares_argument = True

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
        self.name = name
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.choices = None if choices is None else list(choices)
        if self.choices is not None and not self.choices:
            raise ValueError(f"the list of choices of the argument '{name}' is empty")
        self.description = self._description_with_choices(description)
        self._conditionally_included = False
        if self.default_value is not None and all(isinstance(p, TextSubstitution) for p in self.default_value):
            default = "".join(p.text for p in self.default_value if isinstance(p, TextSubstitution))
            if self.choices is not None and default not in self.choices:
                raise InvalidArgumentError(
                    f'Argument "{name}" has the default value "{default}", which is not one of its choices: '
                    f"{self.choices}"
                )

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<arg name= [default=] [description=]/>`, which can hold `<choice value=/>`."""
        _, options = super().parse(entity, parser)
        options["name"] = parser.escape_characters(entity.get_attr("name"))
        default = entity.get_attr("default", optional=True)
        if default is not None:
            options["default_value"] = parser.parse_substitution(default)
        description = entity.get_attr("description", optional=True)
        if description is not None:
            options["description"] = parser.escape_characters(description)
        choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
        if choices is not None:
            options["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
            for choice in choices:
                choice.assert_entity_completely_parsed()
        return cls, options

    def describe(self) -> str:
        return f"DeclareLaunchArgument('{self.name}')"

    def execute(self, context: LaunchContext) -> None:
        """Keep the passed value, or set the default.

        Raises MissingArgumentError if there is neither, InvalidArgumentError if the value is not one of the choices.
        """
        configurations = context.launch_configurations
        if self.name not in configurations:
            if self.default_value is None:
                known = "" if not self.description else f" ({self.description})"
                raise MissingArgumentError(
                    f'Required launch argument "{self.name}" was not provided.{known} Give it as {self.name}:=<value>.'
                )
            configurations[self.name] = perform_substitutions(context, self.default_value)
        value = configurations[self.name]
        if self.choices is not None and value not in self.choices:
            sentence = (
                f'Argument "{self.name}" provided value "{value}" is not valid. Valid options are: {self.choices}'
            )
            launch_logging.get_logger("launch").error(sentence)
            raise InvalidArgumentError(sentence + did_you_mean(str(value), self.choices))

    def _description_with_choices(self, description: str | None) -> str:
        text = "no description given" if description is None else description
        if self.choices is None:
            return text
        if description is None:
            return f"One of: {self.choices}"
        return f"{text}{'' if text.endswith('.') else '.'} Valid choices are: {self.choices}"
