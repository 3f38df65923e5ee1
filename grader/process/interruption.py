"""Orderly end of a process on a signal, even if it arrives where Python drops exceptions, such as in a `__del__`, or
where an exception would leave a lock taken (`sim/postponed_signal.py`).
"""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Iterator
from types import FrameType

from gz_course.sim.postponed_signal import postponed, send_again


def end_on(*numbers: signal.Signals) -> None:
    """Exit on these signals as after Ctrl-C, with exit code 128 + number, and close all context managers before.

    A SIGHUP that is ignored stays ignored, as `nohup` promises; a SIGINT that is, as a shell's `&` does.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        hear_interrupts()
    for number in numbers:
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    sys.unraisablehook = _unraisable


def hear_interrupts() -> None:
    """Raise KeyboardInterrupt on SIGINT, even if this process was started with SIGINT ignored."""
    signal.signal(signal.SIGINT, _interrupt)


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Ignore further signals that would end this process, while it ends what it has started; for the main thread."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.signal(number, signal.SIG_IGN) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)


def _stop(number: int, frame: FrameType | None) -> None:
    if not postponed(number, frame):
        sys.exit(128 + number)


def _interrupt(number: int, frame: FrameType | None) -> None:
    if not postponed(number, frame):
        raise KeyboardInterrupt


def _unraisable(dropped: sys.UnraisableHookArgs) -> None:
    error = dropped.exc_value
    if isinstance(error, KeyboardInterrupt):
        send_again(signal.SIGINT)
    elif isinstance(error, SystemExit) and isinstance(error.code, int) and error.code > 128:
        send_again(error.code - 128)
    else:
        sys.__unraisablehook__(dropped)
