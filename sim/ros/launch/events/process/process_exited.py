"""The event for the end of a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.events.process.running_process_event import RunningProcessEvent


class ProcessExited(RunningProcessEvent):
    """The end of a process with its exit code `returncode`, or -n for signal n."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.returncode = returncode
