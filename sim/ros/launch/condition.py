"""The base class of conditions, which decide whether an action is executed. The conditions are in
`launch.conditions`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext


class Condition:
    """A condition that holds if `predicate(context)` is true; without a predicate it always holds."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        return self._predicate is None or bool(self._predicate(context))
