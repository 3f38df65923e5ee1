"""Waits whose patience is counted by the clock of the run, which stands still while its processes want a processor.

The grader keeps that clock (`fair_clock.py`) and tells it; so on a busy machine nobody waits too short a time.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from . import grader_requests
from .signals import Signal
from .thread_monitor import ThreadMonitor, sleep

SLICE = 0.01  # [s] between two looks
ASKING = 0.5  # [s] of real time that a wait for a signal lasts before the grader is asked for its clock


def await_found(threads: ThreadMonitor, ok: Callable[[], bool], is_found: Callable[[], Any], seconds: float) -> bool:
    """Wait, at work, until discovery has found something; return whether it has.

    At most for some seconds of the run in which nobody else is at work, and while `ok()`.
    """
    since = None
    with threads.at_work():
        while not (found := bool(is_found())) and ok():
            told = grader_requests.ask({"looking": True})
            now = told.get("now", math.inf)
            if since is None or told.get("others"):
                since = now
            if now - since >= seconds or "error" in told:
                break
            sleep(SLICE)
    return found


def await_signal(threads: ThreadMonitor, signal: Signal, seconds: float) -> bool:
    """Wait, at work, until a signal is set, at most for some seconds of the run; return whether it is."""
    since = None
    with threads.at_work():
        while not signal.wait(ASKING):
            told = grader_requests.ask({"time": True})
            now = told.get("now", math.inf)
            since = now if since is None else since
            if now - since >= seconds or "error" in told:
                return signal.wait(0)
    return True
