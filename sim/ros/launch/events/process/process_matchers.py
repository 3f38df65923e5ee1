"""Matchers of processes, for SignalProcess and ShutdownProcess."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

ProcessMatcher = Callable[[Any], bool]


def matches_pid(pid: int) -> ProcessMatcher:
    """Return a matcher for the process with this id."""
    return lambda action: _detail(action, "pid") == pid


def matches_name(name: str) -> ProcessMatcher:
    """Return a matcher for processes of this name, with or without its number suffix."""

    def matches(action: Any) -> bool:
        label = _detail(action, "name")
        return label is not None and name in (label, label.rpartition("-")[0])

    return matches


def matches_executable(executable: str) -> ProcessMatcher:
    """Return a matcher for processes whose command begins with this word."""
    return lambda action: (_detail(action, "cmd") or [None])[0] == executable


def _detail(action: Any, key: str) -> Any:
    return (getattr(action, "process_details", None) or {}).get(key)
