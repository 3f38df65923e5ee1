"""Level C: no namespaces. Landlock for files, TCP, signals and tracing; UDP is open, processes are visible."""

from __future__ import annotations

from gz_course.grader.run.sandbox.init import landlock
from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "Landlock and limits; the network is not isolated"
PRIVATE_NETWORK = False
NAMESPACES = ""
LANDLOCK = True


def missing() -> str:
    """Return in a few words what this level lacks here; empty if it can be tried."""
    return "" if landlock.abi() else "this kernel has no Landlock"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the command that runs `init`, which restricts itself and becomes the submission."""
    return init
