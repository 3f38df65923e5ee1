"""The base class of an action that stands for several processes, as event handlers see it."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.action import Action


class ActionOfProcesses(Action):
    """An action that is executed by starting others: their starts and their output are its own, and it ends with the
    last of them.
    """

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        self.processes: list[Action] = []
        self._ended: list[Action] = []

    def ends_with(self, action: Action) -> bool:
        """Note that one of the processes has ended; return whether it was the last."""
        if not any(each is action for each in self._ended):
            self._ended.append(action)
        return len(self._ended) == len(self.processes)
