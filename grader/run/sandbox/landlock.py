"""What the levels with Landlock (B and C) have in common: the submission's first process locks itself in.

A level is a file of `levels/`; these are its `missing` and `command`. The locking is `grader/run/inside/landlock.py`.
"""

from __future__ import annotations

from gz_course.grader.run.sandbox.order import Order


def missing() -> str:
    """Say in a few words what such a level lacks here; an empty text if it can be tried."""
    from gz_course.grader.run.inside import landlock

    return "" if landlock.abi() else "this kernel has no Landlock"


def command(order: Order, init: list[str]) -> list[str]:
    """Return the command that runs `init`, which builds its box by itself and becomes the submission."""
    return init
