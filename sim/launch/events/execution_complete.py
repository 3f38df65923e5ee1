"""Events of the launch itself: an action is done, a timer is due, the launch is to end."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.launch.event import Event

if TYPE_CHECKING:
    from gz_course.sim.launch.action import Action
    from gz_course.sim.launch.launch_description import LaunchDescription


class ExecutionComplete(Event):
    """An action is done: executed, and its process, timer or coroutine has ended."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self.__action = action

    @property
    def action(self) -> Action:
        """The action."""
        return self.__action


class TimerEvent(Event):
    """The time of a TimerAction has come."""

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Any) -> None:
        self.__timer_action = timer_action

    @property
    def timer_action(self) -> Any:
        """The TimerAction."""
        return self.__timer_action


class Shutdown(Event):
    """The launch is to end, for the `reason` given; `due_to_sigint` tells Ctrl-C from other reasons."""

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.__reason = reason
        self.__due_to_sigint = due_to_sigint

    @property
    def reason(self) -> str:
        """The reason in words."""
        return self.__reason

    @property
    def due_to_sigint(self) -> bool:
        """Whether Ctrl-C was the reason."""
        return self.__due_to_sigint


class IncludeLaunchDescription(Event):
    """A launch description is to be visited."""

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: LaunchDescription) -> None:
        self.__launch_description = launch_description

    @property
    def launch_description(self) -> LaunchDescription:
        """The launch description."""
        return self.__launch_description


def matches_action(target_action: Action) -> Callable[[Event], bool]:
    """Return a matcher for events of this action."""

    def matches(event: Event) -> bool:
        return getattr(event, "action", None) is target_action

    return matches
