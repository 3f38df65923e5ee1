"""The event that a timer is due."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.event import Event


class TimerEvent(Event):
    """The event that the period of a TimerAction has passed."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Any) -> None:
        self.timer_action = timer_action
