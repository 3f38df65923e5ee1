"""Nodes in another ROS domain than the run's: nobody but each other can hear them, so nothing waits for anybody else.

A node joins a domain by its context (`Context`, `rclpy.init(domain_id=...)`). Its topics are called by another name in
reports, `/cmd_vel in domain 7`: what is compared by name, such as endpoints that must match and messages that must be
taken, then concerns the nodes of one domain. No such topic is one of the grader's.
"""

from __future__ import annotations

import os
from typing import Any

DOMAIN = "ROS_DOMAIN_ID"

_own = ""


def begin() -> None:
    """Note the domain of the run, before the submission can change the variable."""
    global _own
    _own = os.environ.get(DOMAIN, "")


def mark(endpoint: Any, node: Any) -> None:
    """Note for an endpoint of a node in which domain it is."""
    if name := apart(node):
        endpoint.course_domain = name


def apart(node: Any) -> str:
    """Return what distinguishes the topics of a node in another domain; empty for one in the domain of the run."""
    if (name := getattr(node, "course_domain", None)) is None:
        domain = node.context.get_domain_id()
        name = node.course_domain = "" if str(domain) == (_own or "0") else f" in domain {domain}"
    return str(name)


def follows_clock(node: Any) -> bool:
    """Return whether a node gets the simulated time of the run."""
    return bool(node._time_source.ros_time_is_active) and not apart(node)


def of(endpoint: Any) -> str:
    """Return the same for a publisher or subscription."""
    return str(getattr(endpoint, "course_domain", ""))
