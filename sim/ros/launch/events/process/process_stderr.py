"""The event for output of a process on stderr."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.events.process.process_io import ProcessIO


class ProcessStderr(ProcessIO):
    """Bytes `text` that a process has written to stderr."""

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=2, **kwargs)
