"""SIGINT and SIGTERM as a KeyboardInterrupt that is not lost: at the latest the next `check` raises it.

Python drops an exception that a signal raises in a callback from C or in a `__del__`, and rclpy has many of both.
`command_line` listens; `graph.Graph` checks in every loop that waits.
"""

from __future__ import annotations

import signal
import sys
from types import FrameType

_heard = False


def listen() -> None:
    """Listen to both signals, also where a shell's `&` has set SIGINT to ignored."""
    global _heard
    _heard = False
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    sys.unraisablehook = _unraisable


def check() -> None:
    """Raise KeyboardInterrupt if a signal has come."""
    if _heard:
        raise KeyboardInterrupt


def _unraisable(dropped: sys.UnraisableHookArgs) -> None:
    """Keep quiet about an interruption that Python drops: `check` raises it again."""
    if not (_heard and isinstance(dropped.exc_value, KeyboardInterrupt)):
        sys.__unraisablehook__(dropped)


def _interrupt(number: int, frame: FrameType | None) -> None:
    global _heard
    _heard = True
    raise KeyboardInterrupt
