"""The action that sets the folder of the log files of all processes of a scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("set_ros_log_dir")
class SetROSLogDir(Action):
    """Sets ROS_LOG_DIR for the following processes; the log of the launch itself stays where it is."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<set_ros_log_dir new_log_dir=/>`."""
        _, options = super().parse(entity, parser)
        options["new_log_dir"] = parser.parse_substitution(entity.get_attr("new_log_dir"))
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        context.environment["ROS_LOG_DIR"] = perform_substitutions(context, self.log_dir)
