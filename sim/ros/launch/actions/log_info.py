"""The action that logs a line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("log")
class LogInfo(Action):
    """Logs `[INFO] [launch.user]: msg`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.msg = normalize_to_list_of_substitutions(msg)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<log message=/>`."""
        _, options = super().parse(entity, parser)
        options["msg"] = parser.parse_substitution(entity.get_attr("message"))
        return cls, options

    def describe(self) -> str:
        return f"LogInfo({describe_substitutions(self.msg)})"

    def execute(self, context: LaunchContext) -> None:
        launch_logging.get_logger("launch.user").info(perform_substitutions(context, self.msg))
