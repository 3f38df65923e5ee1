"""A deadline for leaving a process in which DDS may block.

Fast DDS can deadlock while a participant is removed and others come and go. rclpy holds the interpreter's lock
meanwhile, so no Python thread and no signal handler of Python can run. The timer here is the system's, and calls
`_exit` of the C library.

Source: POSIX.1-2017, `timer_create` and `<signal.h>` (SIGEV_THREAD); `sigevent` as laid out by glibc
"""

from __future__ import annotations

import contextlib
import ctypes
import sys
import time

PATIENCE = 10.0  # [s] for a node to be destroyed; on a busy machine only its farewell is lost
_SIGEV_THREAD = 2


class _SignalEvent(ctypes.Structure):
    _fields_ = (
        ("value", ctypes.c_int64),  # `union sigval`, passed to the function
        ("signal", ctypes.c_int),
        ("notify", ctypes.c_int),
        ("function", ctypes.c_void_p),
        ("attributes", ctypes.c_void_p),
        ("padding", ctypes.c_char * 64),
    )


def end_within(code: int, patience: float = PATIENCE) -> None:
    """Flush the output, and let the process end with exit code `code` after `patience` [s], whatever it does then."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    library = ctypes.CDLL(None)
    end = ctypes.cast(library._exit, ctypes.c_void_p).value
    event = _SignalEvent(value=code, notify=_SIGEV_THREAD, function=end)
    timer = ctypes.c_void_p()
    when = (ctypes.c_long * 4)(0, 0, int(patience), int(patience % 1 * 1e9))  # no interval; then seconds, nanoseconds
    if library.timer_create(time.CLOCK_MONOTONIC, ctypes.byref(event), ctypes.byref(timer)) == 0:
        library.timer_settime(timer, 0, when, None)
