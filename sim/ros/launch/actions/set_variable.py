"""The base of the actions that set a launch configuration or an environment variable."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


class SetVariable(Action):
    """Base of actions that set the variable `name`; `_variables` returns the mapping it belongs to."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read the attributes `name` and `value`."""
        _, options = super().parse(entity, parser)
        options["name"] = parser.parse_substitution(entity.get_attr("name"))
        options["value"] = parser.parse_substitution(entity.get_attr("value"))
        return cls, options

    def describe(self) -> str:
        return f"{type(self).__name__}({describe_substitutions(self.name)}, {describe_substitutions(self.value)})"

    def execute(self, context: LaunchContext) -> None:
        name = perform_substitutions(context, self.name)
        self._variables(context)[name] = perform_substitutions(context, self.value)

    def _variables(self, context: LaunchContext) -> MutableMapping[str, Any]:
        raise NotImplementedError
