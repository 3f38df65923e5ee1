"""The event that a process was started."""

from __future__ import annotations

from gz_course.sim.launch.events.process.running_process_event import RunningProcessEvent


class ProcessStarted(RunningProcessEvent):
    """The event that a process was started."""

    name = "launch.events.process.ProcessStarted"
