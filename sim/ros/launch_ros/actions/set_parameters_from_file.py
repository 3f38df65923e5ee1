"""The action that sets the parameters of a file for all nodes of a scope."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.actions.set_parameter import PARAMETERS

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("set_parameters_from_file")
class SetParametersFromFile(Action):
    """Passes a parameter file to the following nodes; a node's own `parameters` take precedence."""

    def __init__(self, filename: SomeSubstitutionsType | os.PathLike[str], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.filename = normalize_to_list_of_substitutions(filename)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<set_parameters_from_file filename=/>`."""
        _, options = super().parse(entity, parser)
        options["filename"] = parser.parse_substitution(entity.get_attr("filename"))
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        there = context.launch_configurations.get(PARAMETERS, ())
        context.launch_configurations[PARAMETERS] = (*there, perform_substitutions(context, self.filename))
