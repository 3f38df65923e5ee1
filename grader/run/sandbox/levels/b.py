"""Level B: the same box, built by Python itself (`grader/run/sandbox/init/namespaces.py`), and Landlock within it."""

from __future__ import annotations

from gz_course.grader.run.sandbox.init import landlock
from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "namespaces built by Python, a user of its own, a private network, Landlock, limits"
PRIVATE_NETWORK = True
NAMESPACES = "own"
LANDLOCK = True


def missing() -> str:
    """Say in a few words what this level lacks here; an empty text if it can be tried."""
    return "" if landlock.abi() else "this kernel has no Landlock"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the command that runs `init`, which locks itself in and becomes the submission."""
    return init
