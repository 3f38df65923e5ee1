"""The action that remaps a name of all nodes of a scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser

REMAPS = "ros_remaps"


@expose_action("set_remap")
class SetRemap(Action):
    """Remaps the name `src` to `dst` in the following nodes."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<set_remap from= to=/>`."""
        _, options = super().parse(entity, parser)
        options["src"] = parser.parse_substitution(entity.get_attr("from"))
        options["dst"] = parser.parse_substitution(entity.get_attr("to"))
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        there = context.launch_configurations.get(REMAPS, ())
        context.launch_configurations[REMAPS] = (*there, pair)
