"""The event that writes to a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.events.process.process_io import ProcessIO


class ProcessStdin(ProcessIO):
    """Writes `text` to the stdin of the process that `action` started."""

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=0, **kwargs)
