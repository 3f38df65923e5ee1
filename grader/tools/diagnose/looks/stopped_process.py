"""A process that was stopped with Ctrl-Z: its terminal shows a prompt, but it still exists, silent."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("no_world", "paused_world")


def look(system: System) -> Iterator[Finding]:
    """Find every stopped process of the domain or the partition."""
    for process in system.stopped:
        yield Finding(
            Severity.ERROR,
            f"The process {process.pid} is stopped (Ctrl-Z), so it neither sends nor hears anything.",
            f"Let it go on with fg in its terminal (or kill -CONT {process.pid}); end programs with Ctrl-C.",
            (process.command,),
        )
