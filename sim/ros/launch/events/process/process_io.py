"""The base class of events for input and output of a process."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.events.process.running_process_event import RunningProcessEvent


class ProcessIO(RunningProcessEvent):
    """Bytes `text` that a process has written or will read; `fd` is 0 stdin, 1 stdout, 2 stderr."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.text = text
        self.fd = fd
        self.from_stdin, self.from_stdout, self.from_stderr = (fd == number for number in range(3))
