"""Time as a test sets it, for one thread: other threads of the process, such as those of networks, keep the real one.

A thread that reads a clock of a test may plan for a moment that never comes, and be silent in all later tests.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any


class OwnTime:
    """Stands for the module `time` in a module under test; what is given is what the thread that makes it is told."""

    def __init__(self, **told: Callable[..., Any]) -> None:
        self._told = told
        self._thread = threading.get_ident()

    def __getattr__(self, name: str) -> Any:
        mine = name in self._told and threading.get_ident() == self._thread
        return self._told[name] if mine else getattr(time, name)
