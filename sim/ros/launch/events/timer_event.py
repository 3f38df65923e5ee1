"""The event of an expired timer."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.event import Event


class TimerEvent(Event):
    """Emitted when the period of a TimerAction has passed."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Any) -> None:
        self.timer_action = timer_action
