"""Level D: limits, a process group of its own and a sweep for daemons. Keeps accidents in; no jail for hostile code."""

from __future__ import annotations

from gz_course.grader.run.sandbox.spec import SandboxSpec

ABOUT = "limits and a process group of its own: keeps accidents in, no jail for hostile code"
PRIVATE_NETWORK = False
NAMESPACES = ""
LANDLOCK = False


def missing() -> str:
    """Nothing is needed."""
    return ""


def command(spec: SandboxSpec, init: list[str]) -> list[str]:
    """Return the submission's own command; limits are put on it from outside."""
    return spec.command
