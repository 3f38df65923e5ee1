"""The event that a process has ended."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.events.process.running_process_event import RunningProcessEvent


class ProcessExited(RunningProcessEvent):
    """The event that a process has ended, with its exit code `returncode`; -n when signal n ended it."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.returncode = returncode
