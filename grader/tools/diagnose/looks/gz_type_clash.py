"""A bridge that names another Gazebo type than its topic has: gz-transport never connects the two."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names
from gz_course.sim.gz.msgs import canonical_name

_ANY = "google.protobuf.Message"


def look(system: System) -> Iterator[Finding]:
    """Find every entry of a bridge whose type differs from that of the other endpoints of its topic."""
    for bridge, entry in system.entries():
        if not entry.gz_type:
            continue
        for wanted, publish, verb in (
            (entry.direction.to_ros, True, "publishes"),
            (entry.direction.to_gz, False, "listens for"),
        ):
            types = {end.msg_type_name for end in system.gz_users(entry.gz_topic, publish=publish)} - {_ANY}
            if not wanted or not types or canonical_name(entry.gz_type) in {canonical_name(each) for each in types}:
                continue
            yield Finding(
                Severity.ERROR,
                f"The bridge {bridge.node} has {entry.gz_type} for {entry.gz_topic}, but Gazebo {verb} {names(types)} "
                "there: no message passes.",
                f"Give gz_type_name: {sorted(types)[0]} to the bridge, with a ros_type_name that goes with it.",
                (f"bridged to {entry.ros_topic} ({entry.ros_type})",),
                frozenset({entry.ros_topic}),
            )
