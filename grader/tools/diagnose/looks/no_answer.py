"""A node that is in the graph and does not answer: it was killed, hangs, or was never added to an executor."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System

BEFORE = ("missing_system",)


def look(system: System) -> Iterator[Finding]:
    """Find nodes with parameter services that gave no answer."""
    for node in system.ros.nodes:
        if node.answers is not False:
            continue
        ends = [end for end in system.ros.endpoints if end.node == node.name]
        topics = sorted({end.topic for end in ends} - {"/rosout", "/parameter_events"})
        if system.is_bridge(node.name):
            sentence = (
                f"The bridge {node.name} does not answer: its process hangs or was killed, so it bridges nothing."
            )
            fix = "Start the bridge again; ROS forgets a killed one after about 20 s."
        else:
            sentence = (
                f"{node.name} does not answer: it never spins, is stuck in a callback, or its process was killed."
            )
            fix = "Give the node to rclpy.spin() and keep callbacks short: no loop and no sleep in them."
        yield Finding(
            Severity.ERROR,
            sentence,
            fix,
            (f"its topics: {', '.join(topics[:8])}",) if topics else (),
            frozenset(topics) if system.is_bridge(node.name) else frozenset(),
        )
