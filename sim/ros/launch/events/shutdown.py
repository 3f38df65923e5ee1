"""The event that ends the launch."""

from __future__ import annotations

from gz_course.sim.ros.launch.event import Event


class Shutdown(Event):
    """Ends the launch with a `reason` in words; `due_to_sigint` is True after Ctrl-C."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint
