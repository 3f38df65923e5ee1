"""Level C: no namespaces. Landlock for files, TCP, signals and tracing; UDP stays open, processes stay visible."""

from __future__ import annotations

from grader.run.sandbox.order import Order

ABOUT = "Landlock and limits; the network is not isolated"
PRIVATE_NETWORK = False
WALLS = ""
LANDLOCK = True


def missing() -> str:
    """Say in a few words what this level lacks here; an empty text if it can be tried."""
    from grader.run.inside import landlock

    return "" if landlock.abi() else "this kernel has no Landlock"


def command(order: Order, init: list[str]) -> list[str]:
    """Return the command that locks itself in and becomes the submission."""
    return init
