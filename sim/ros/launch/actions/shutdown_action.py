"""The action that ends the launch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.actions.emit_event import EmitEvent
from gz_course.sim.ros.launch.events import Shutdown as ShutdownEvent
from gz_course.sim.ros.launch.events.process import ProcessExited
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("shutdown")
class Shutdown(EmitEvent):
    """Ends the launch; as `on_exit` of a process its reason is that this process was required."""

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<shutdown [reason=]/>`."""
        _, options = super().parse(entity, parser)
        reason = entity.get_attr("reason", optional=True)
        if reason:
            options["reason"] = parser.escape_characters(reason)
        return cls, options

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited):
            launch_logging.get_logger("launch").info(
                f"process[{event.process_name}] was required: shutting down launched system"
            )
        return super().execute(context)
