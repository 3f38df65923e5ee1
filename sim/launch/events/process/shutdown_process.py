"""The event that ends a process."""

from __future__ import annotations

from gz_course.sim.launch.events.process.process_targeted_event import ProcessTargetedEvent


class ShutdownProcess(ProcessTargetedEvent):
    """The event that ends a process: SIGINT, later SIGTERM, later SIGKILL."""

    name = "launch.events.process.ShutdownProcess"
