"""Orderly end of a process on a signal, even if it arrives where Python drops exceptions, such as in a `__del__`."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator
from typing import NoReturn

AGAIN = 0.02  # [s] until a dropped signal is sent again


def end_on(*numbers: signal.Signals) -> None:
    """Exit on these signals as after Ctrl-C, with exit code 128 + number, and close all context managers before.

    A SIGHUP that is ignored stays ignored, as `nohup` promises.
    """
    for number in numbers:
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    sys.unraisablehook = _unraisable


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


def _stop(number: int, _: object) -> NoReturn:
    sys.exit(128 + number)


def _unraisable(dropped: sys.UnraisableHookArgs) -> None:
    error = dropped.exc_value
    if isinstance(error, KeyboardInterrupt):
        _send_again(signal.SIGINT)
    elif isinstance(error, SystemExit) and isinstance(error.code, int) and error.code > 128:
        _send_again(error.code - 128)
    else:
        sys.__unraisablehook__(dropped)


def _send_again(number: int) -> None:
    timer = threading.Timer(AGAIN, os.kill, (os.getpid(), number))
    timer.daemon = True
    timer.start()
