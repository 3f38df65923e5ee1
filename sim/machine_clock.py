"""The clock of the machine, for code of ours that waits for the machine: for discovery, or for a program that starts.

In a grading, the clocks and sleeps of Python follow simulated time, which may stand still, or go on faster than the
machine. The grader's agent therefore replaces the three functions here by those of the run's clock
(`grader/run/agent/course_agent/python_3.py`). Call them by the name of this module: `machine_clock.now()`.

What waits for the world (a rate, a transform, the next message) takes simulated time, as the nodes of students do.
"""

from __future__ import annotations

import threading
import time


def now() -> float:
    """Return the time [s] of the machine since some moment."""
    return time.monotonic()


def pause(seconds: float) -> None:
    """Let some `seconds` of the machine pass."""
    time.sleep(seconds)


def await_event(event: threading.Event, seconds: float) -> bool:
    """Wait for an event that a message of the world sets, at most some `seconds`; return whether it is set.

    In a grading they are counted by the run's clock until simulated time begins, and from then on by that.
    """
    return event.wait(seconds)
