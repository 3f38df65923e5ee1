"""The action that runs a test program."""

from __future__ import annotations

import signal
from typing import Any

from gz_course.sim.ros.launch.actions import EmitEvent, ExecuteProcess, TimerAction
from gz_course.sim.ros.launch.events import matches_action
from gz_course.sim.ros.launch.events.process import SignalProcess
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType


class Test(ExecuteProcess):
    """Runs a program; after `timeout` [s] it gets SIGKILL."""

    __test__ = False  # pytest collects classes of this name

    def __init__(self, *, timeout: float | SomeSubstitutionsType | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.timeout = timeout

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        following = super().execute(context) or []
        if not self.timeout:
            return following
        kill = SignalProcess(signal_number=signal.SIGKILL, process_matcher=matches_action(self))
        return [*following, TimerAction(period=self.timeout, actions=[EmitEvent(event=kill)])]
