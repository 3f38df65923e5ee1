"""Signals that come while a lock is taken or given back: their handlers must not raise there.

The machinery of imports holds a lock for a few lines at a time. An exception of a handler that comes between taking the
lock and the `try` that gives it back leaves it taken: from then on every other thread waits for ever for its next
import, and whoever joins such a thread waits, too. So it is with a `threading.Condition`, on which events and queues
are built: its `__enter__` and `__exit__` are functions of Python, in which a handler may come after the lock was taken,
or before it is given back. A handler that raises therefore asks here first.

Source: importlib/_bootstrap.py of CPython 3.11 to 3.14, `_get_module_lock` and `_ModuleLockManager`; threading.py,
`Condition`.
"""

from __future__ import annotations

import os
import threading
from types import FrameType

AGAIN = 0.02  # [s] until a signal is sent again
_MACHINERY = "<frozen importlib._bootstrap>"
_OF_A_CONDITION = ("__enter__", "__exit__", "_acquire_restore")
_LOCKING = frozenset(vars(threading.Condition)[name].__code__ for name in _OF_A_CONDITION)


def postponed(number: int, frame: FrameType | None) -> bool:
    """Return whether a signal has come at such a moment; it is sent again then."""
    if frame is None or (frame.f_code.co_filename != _MACHINERY and frame.f_code not in _LOCKING):
        return False
    send_again(number)
    return True


def send_again(number: int) -> None:
    """Send a signal to this process after a moment."""
    timer = threading.Timer(AGAIN, os.kill, (os.getpid(), number))
    timer.daemon = True
    timer.start()
