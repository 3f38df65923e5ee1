"""The action that selects the clock of all nodes of a scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch_ros.actions.set_parameter import SetParameter

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("set_use_sim_time")
class SetUseSimTime(SetParameter):
    """Sets the parameter use_sim_time of the following nodes: with True they use the time of /clock."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<set_use_sim_time value=/>`."""
        _, options = super(SetParameter, cls).parse(entity, parser)
        options["value"] = parser.parse_if_substitutions(entity.get_attr("value", data_type=bool))
        return cls, options
