"""The action that sets a parameter of all nodes of a scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser

# Name -> value pairs and paths of files, in the order they were set. A tuple, because scopes must not share a list.
PARAMETERS = "global_params"


@expose_action("set_parameter")
class SetParameter(Action):
    """Sets a parameter of the following nodes; a node's own `parameters` take precedence."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__parameter = Parameter(name, value)
        self.name, self.value = self.__parameter.name, self.__parameter.value

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<set_parameter name= value=/>`."""
        _, options = super().parse(entity, parser)
        options["name"] = parser.parse_substitution(entity.get_attr("name"))
        value = entity.get_attr("value", data_type=None)
        # A text is a value in YAML, also where the launch file itself is YAML: "3" is a number.
        options["value"] = parser.parse_substitution(value) if isinstance(value, str) else value
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        there = context.launch_configurations.get(PARAMETERS, ())
        context.launch_configurations[PARAMETERS] = (*there, self.__parameter.evaluate(context))
