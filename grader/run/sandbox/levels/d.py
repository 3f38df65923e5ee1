"""Level D: limits, a process group of its own and a sweep for daemons. Keeps accidents in; no jail for hostile code."""

from __future__ import annotations

from gz_course.grader.run.sandbox.order import Order

ABOUT = "limits and a process group of its own: keeps accidents in, no jail for hostile code"
PRIVATE_NETWORK = False
WALLS = ""
LANDLOCK = False


def missing() -> str:
    """Nothing is needed."""
    return ""


def command(order: Order, init: list[str]) -> list[str]:
    """Return the submission's own command; limits are put on it from outside."""
    return order.command
