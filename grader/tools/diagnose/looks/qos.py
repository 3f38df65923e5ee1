"""Incompatible quality of service: a subscription requests more than a publisher offers, so nothing arrives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rclpy.qos import DurabilityPolicy, LivelinessPolicy, ReliabilityPolicy

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System


def look(system: System) -> Iterator[Finding]:
    """Find every publisher and subscription of one topic and type with incompatible QoS."""
    for topic in sorted({end.topic for end in system.ros.endpoints}):
        told = set()
        for sender in system.ros_ends(topic, publish=True):
            for listener in system.ros_ends(topic, publish=False):
                pair = (sender.node, listener.node)
                if sender.type != listener.type or pair in told or not (policies := clashes(sender.qos, listener.qos)):
                    continue
                told.add(pair)
                policy, offered, wanted = policies[0]
                yield Finding(
                    Severity.ERROR,
                    f"On {topic} {sender.node} offers {policy} {offered}, but {listener.node} asks for {wanted}: "
                    "no message arrives.",
                    _fix(policy, offered, wanted, system.is_bridge(listener.node), topic),
                    tuple(f"{name}: {offers} offered, {asks} asked for" for name, offers, asks in policies),
                    frozenset({topic}),
                )


def clashes(offered: Any, wanted: Any) -> list[tuple[str, str, str]]:
    """Return (policy, offered, requested) of each policy in which a publisher offers less than is requested.

    Source: ROS 2 documentation, "Quality of Service settings", section "QoS compatibilities".
    """
    found = []
    if wanted.reliability == ReliabilityPolicy.RELIABLE and offered.reliability == ReliabilityPolicy.BEST_EFFORT:
        found.append(("reliability", "BEST_EFFORT", "RELIABLE"))
    if wanted.durability == DurabilityPolicy.TRANSIENT_LOCAL and offered.durability == DurabilityPolicy.VOLATILE:
        found.append(("durability", "VOLATILE", "TRANSIENT_LOCAL"))
    for name in ("deadline", "liveliness_lease_duration"):
        asks, offers = getattr(wanted, name).nanoseconds, getattr(offered, name).nanoseconds
        if asks > 0 and (offers == 0 or asks < offers):  # 0 stands for infinity
            found.append((name, f"{offers * 1e-9:g} s" if offers else "none", f"{asks * 1e-9:g} s"))
    by_topic, automatic = LivelinessPolicy.MANUAL_BY_TOPIC, LivelinessPolicy.AUTOMATIC
    if wanted.liveliness == by_topic and offered.liveliness == automatic:
        found.append(("liveliness", "AUTOMATIC", "MANUAL_BY_TOPIC"))
    return found


def _fix(policy: str, offered: str, wanted: str, bridge: bool, topic: str) -> str:
    if bridge and policy in ("reliability", "durability"):
        value = offered.lower()
        return (
            f"Publish with {policy} {wanted}, or start the bridge with "
            f"-p qos_overrides.{topic}.subscription.{policy}:={value}"
        )
    return f"Publish with {policy} {wanted}, or subscribe with {offered} (a subscription may ask for less, never more)."
