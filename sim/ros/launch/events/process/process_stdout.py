"""The event for output of a process on stdout."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.events.process.process_io import ProcessIO


class ProcessStdout(ProcessIO):
    """Bytes `text` that a process has written to stdout."""

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **kwargs: Any) -> None:
        super().__init__(text=text, fd=1, **kwargs)
