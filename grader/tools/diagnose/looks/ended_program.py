"""A program that ended at its start: what it said is lost in another terminal, and nothing of it is in the graphs."""

from __future__ import annotations

import time
from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("not_bridged", "no_world")


def look(system: System) -> Iterator[Finding]:
    """Find the programs that ended for their own arguments or files."""
    for words in system.ended:
        minutes = round((time.time() - words.ended) / 60)
        ago = "just now" if minutes < 1 else f"{minutes} min ago"
        yield Finding(
            Severity.ERROR,
            f"{words.program} was started {ago} and ended at once: {words.sentences[0].rstrip('.')}.",
            "Mend that and start it again."
            + (
                " ros2 run ros_gz_bridge lint FILE shows every fault of a bridge's file."
                if words.program == "parameter_bridge"
                else ""
            ),
            words.sentences[1:6],
        )
