"""The event for the completion of an action."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.action import Action


class ExecutionComplete(Event):
    """Emitted after `action` was executed and its process, timer or coroutine has ended."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self.action = action
