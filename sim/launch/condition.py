"""Decides whether an action is executed; the usual ones are in `launch.conditions`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gz_course.sim.launch.launch_context import LaunchContext


class Condition:
    """Calls `predicate(context)`; without a predicate it is always true."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the action is to be executed."""
        return self._predicate is None or bool(self._predicate(context))
