"""The rules for names of topics and services on the ROS side and on the Gazebo side.

`config`, `arguments` and `parameters` check names here, before there is a node that would refuse them.

Source: https://design.ros2.org/articles/topic_and_service_names.html
"""

from __future__ import annotations

import re

from gz_course.sim.gz.transport import naming

_ROS_TOKEN = r"(?:[A-Za-z_]|\{\w+\})(?:\w|\{\w+\})*"
_ROS_NAME = re.compile(rf"(?:~|(?:~/|/)?{_ROS_TOKEN}(?:/{_ROS_TOKEN})*)", re.ASCII)
_LONGEST = 1000


def ros_name_fault(name: str) -> str | None:
    """Return the fault of a ROS topic or service name, or None. `{node}` and `~` are allowed."""
    if len(name) <= _LONGEST and _ROS_NAME.fullmatch(name) and "__" not in name:
        return None
    return (
        f"'{name}' is not a ROS topic name; use letters, digits, '_' and '/', no part starting with a digit, "
        "no '//' or '__', and no '/' at the end"
    )


def gz_name_fault(name: str) -> str | None:
    """Return the fault of a Gazebo topic or service name, or None. `~/x` is allowed, because it can be expanded."""
    rule = naming.broken_rule(name.removeprefix("~/"), may_be_empty=False)
    return f"'{name}' is not a Gazebo topic name: it {rule}" if rule else None


def expand_gz_name(name: str, namespace: str, node_name: str) -> str:
    """Return a Gazebo name expanded like a ROS name: `/abs` is unchanged, `rel` and `~/private` get the node's
    namespace.

    Used for the parameter `expand_gz_topic_names` of ros_gz_bridge.
    """
    if name.startswith("/"):
        return name
    prefix = namespace.rstrip("/")
    if name.startswith("~/"):
        return f"{prefix}/{node_name}/{name[2:]}"
    return f"{prefix}/{name}"
