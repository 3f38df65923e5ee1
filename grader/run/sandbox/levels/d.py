"""Level D: limits, a process group, daemons ended with it. Prevents accidents, but does not stop hostile code."""

from __future__ import annotations

from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "limits and a process group of its own: prevents accidents, does not stop hostile code"
PRIVATE_NETWORK = False
NAMESPACES = ""
LANDLOCK = False


def missing() -> str:
    """Return an empty text: this level works everywhere."""
    return ""


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the submission's own command; limits are set from outside."""
    return spec.command
