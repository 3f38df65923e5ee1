"""The base class of events that act on processes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.launch.event import Event


class ProcessTargetedEvent(Event):
    """Acts on the processes whose action `process_matcher(action)` accepts."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher
