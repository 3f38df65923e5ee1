"""Level C: no namespaces. Landlock for files, TCP, signals and tracing; UDP stays open, processes stay visible."""

from __future__ import annotations

from gz_course.grader.run.sandbox.init import landlock
from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "Landlock and limits; the network is not isolated"
PRIVATE_NETWORK = False
NAMESPACES = ""
LANDLOCK = True


def missing() -> str:
    """Say in a few words what this level lacks here; an empty text if it can be tried."""
    return "" if landlock.abi() else "this kernel has no Landlock"


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the command that runs `init`, which locks itself in and becomes the submission."""
    return init
