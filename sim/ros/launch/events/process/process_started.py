"""The event for the start of a process."""

from __future__ import annotations

from gz_course.sim.ros.launch.events.process.running_process_event import RunningProcessEvent


class ProcessStarted(RunningProcessEvent):
    """Emitted after a process was started, with its process id."""

    name = "launch.events.process.ProcessStarted"
