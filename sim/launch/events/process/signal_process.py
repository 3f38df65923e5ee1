"""What is asked of processes: to take a signal, to end."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

from gz_course.sim.launch.errors import nearest
from gz_course.sim.launch.event import Event

ProcessMatcher = Callable[[Any], bool]


class ProcessTargetedEvent(Event):
    """Base: is for those processes whose action `process_matcher(action)` accepts."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: ProcessMatcher) -> None:
        self.__process_matcher = process_matcher

    @property
    def process_matcher(self) -> ProcessMatcher:
        """Which processes are meant."""
        return self.__process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """Ends a process: SIGINT, later SIGTERM, later SIGKILL."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """Sends a signal, given by its number or name, to a process and all it has started."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | int | signal.Signals, process_matcher: ProcessMatcher) -> None:
        super().__init__(process_matcher=process_matcher)
        if isinstance(signal_number, str):
            names = signal.Signals.__members__
            if signal_number not in names:
                raise ValueError(f"there is no signal {signal_number!r}{nearest(signal_number, names)}")
            self.__signal = names[signal_number]
        else:
            self.__signal = signal.Signals(signal_number)

    @property
    def signal(self) -> signal.Signals:
        """The signal."""
        return self.__signal

    @property
    def signal_name(self) -> str:
        """Its name, such as `SIGINT`."""
        return self.__signal.name


def matches_pid(pid: int) -> ProcessMatcher:
    """Return a matcher for the process of this number."""
    return lambda action: _detail(action, "pid") == pid


def matches_name(name: str) -> ProcessMatcher:
    """Return a matcher for processes of this name, with or without the number behind it."""

    def matches(action: Any) -> bool:
        label = _detail(action, "name")
        return label is not None and name in (label, label.rpartition("-")[0])

    return matches


def matches_executable(executable: str) -> ProcessMatcher:
    """Return a matcher for processes whose command starts with this word."""
    return lambda action: (_detail(action, "cmd") or [None])[0] == executable


def _detail(action: Any, key: str) -> Any:
    return (getattr(action, "process_details", None) or {}).get(key)
