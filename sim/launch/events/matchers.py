"""Matchers of events, for EventHandler."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from gz_course.sim.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.launch.action import Action


def matches_action(target_action: Action) -> Callable[[Event], bool]:
    """Return a matcher for events of this action."""

    def matches(event: Event) -> bool:
        return getattr(event, "action", None) is target_action

    return matches
