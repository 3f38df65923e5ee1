"""Nodes of one name: parameters, services and remappings reach an arbitrary one of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System


def look(system: System) -> Iterator[Finding]:
    """Find names shared by several nodes."""
    for name, number in sorted(Counter(node.name for node in system.ros.nodes).items()):
        if number > 1:
            yield Finding(
                Severity.WARNING,
                f"{number} nodes are called {name}: what is meant for one may reach the other.",
                "End the one left over from an earlier run, or give each a name of its own: --ros-args -r __node:=NAME",
            )
