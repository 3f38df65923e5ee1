"""Turns SIGINT and SIGTERM into a KeyboardInterrupt that is not lost: the next `check` raises it at the latest.

Python drops an exception that a signal raises in a callback from C or in a `__del__`, and rclpy has many of both. Amid
an import it is raised a moment later (`sim/postponed_signal.py`).
"""

from __future__ import annotations

import signal
import sys
from types import FrameType

from gz_course.sim.postponed_signal import postponed

_received = False


def listen() -> None:
    """Handle both signals, even if a shell's `&` has set SIGINT to ignored."""
    global _received
    _received = False
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    sys.unraisablehook = _unraisable


def ignore() -> None:
    """Ignore both signals: the process is about to end."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)


def received() -> bool:
    """Return whether a signal has arrived: an error that comes then may be what C code has made of the interruption."""
    return _received


def check() -> None:
    """Raise KeyboardInterrupt if a signal has arrived."""
    if _received:
        raise KeyboardInterrupt


def _unraisable(dropped: sys.UnraisableHookArgs) -> None:
    """Suppress the report about an interruption that Python drops, because `check` raises it again.

    Suppress that about an object whose `__init__` was interrupted, too: its `__del__` misses attributes.
    """
    if not (_received and isinstance(dropped.exc_value, KeyboardInterrupt | AttributeError)):
        sys.__unraisablehook__(dropped)


def _interrupt(number: int, frame: FrameType | None) -> None:
    global _received
    if postponed(number, frame):
        return
    _received = True
    raise KeyboardInterrupt
