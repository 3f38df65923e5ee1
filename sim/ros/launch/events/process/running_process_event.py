"""The base class of events from processes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.action import Action


class RunningProcessEvent(Event):
    """Data of a process: its action, label (`<name>-<number>`), command, working directory, environment and process id.

    `cwd` None is the working directory of the launch.
    """

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self, *, action: Action, name: str, cmd: list[str], cwd: str | None, env: dict[str, str] | None, pid: int
    ) -> None:
        self.action = self.execute_process_action = action
        self.process_name = name
        self.cmd = cmd
        self.cwd = cwd
        self.env = env
        self.pid = pid
