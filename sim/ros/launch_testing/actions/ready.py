"""The action that lets the tests begin."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity


class ReadyToTest(Action):
    """Starts the active tests when it is executed."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], object]] = []

    def _add_callback(self, callback: Callable[[], object]) -> None:
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        for callback in self._callbacks:
            callback()
        return None
