"""Level B: the same sandbox, built by Python itself (`grader/run/sandbox/init/namespaces.py`), with Landlock inside."""

from __future__ import annotations

from gz_course.grader.run.sandbox.init import landlock
from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "namespaces built by Python, a user of its own, a private network, Landlock, limits"
PRIVATE_NETWORK = True
NAMESPACES = "own"
LANDLOCK = True


def missing() -> str:
    """Return in a few words what this level lacks here; empty if it can be tried."""
    return "" if landlock.abi() else "this kernel has no Landlock"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the command that runs `init`, which restricts itself and starts the submission."""
    return init
