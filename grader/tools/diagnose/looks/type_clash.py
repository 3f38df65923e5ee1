"""Different types on one ROS topic: DDS never connects such endpoints, and reports no error."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("gz_type_clash",)


def look(system: System) -> Iterator[Finding]:
    """Find every topic on which a publisher and a subscription differ."""
    for topic in sorted({end.topic for end in system.ros.endpoints}):
        sent, heard = system.ros_ends(topic, publish=True), system.ros_ends(topic, publish=False)
        pairs = [(a, b) for a in sent for b in heard if a.type != b.type]
        if not pairs:
            continue
        sender, listener = pairs[0]
        yield Finding(
            Severity.ERROR,
            f"{sender.node} publishes {sender.type} on {topic}, but {listener.node} listens for {listener.type}: "
            "no message arrives.",
            f"Use one type on both sides of {topic}: change the publisher, the subscription or the bridge's "
            "ros_type_name.",
            tuple(
                f"{'publishes' if ends is sent else 'listens for'} {kind}: "
                f"{names(end.node for end in ends if end.type == kind)}"
                for ends in (sent, heard)
                for kind in sorted({end.type for end in ends})
            ),
            frozenset({topic}),
        )
