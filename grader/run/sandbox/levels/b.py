"""Level B: the same box, built by Python itself (`grader/run/inside/walls.py`), and Landlock within it."""

from __future__ import annotations

from grader.run.sandbox.order import Order

ABOUT = "namespaces built by Python, a user of its own, a private network, Landlock, limits"
PRIVATE_NETWORK = True
WALLS = "own"
LANDLOCK = True


def missing() -> str:
    """Say in a few words what this level lacks here; an empty text if it can be tried."""
    from grader.run.inside import landlock

    return "" if landlock.abi() else "this kernel has no Landlock"


def command(order: Order, init: list[str]) -> list[str]:
    """Return the command that runs `init` in the box: it builds the box by itself."""
    return init
