"""An endpoint as reports describe it, and whether its QoS is compatible with the grader's."""

from __future__ import annotations

from typing import Any

KEPT = "transient_local"  # kind of topics: those of the grader's that keep messages for subscriptions that join late


def described(node: str, kind: str, topic: str, endpoint: Any, matched: int) -> dict[str, Any]:
    """Return the description of a publisher or subscription (`kind`) of the node with this full name."""
    qos = endpoint.qos_profile
    return {
        "node": node,
        "kind": kind,
        "topic": topic,
        "type": type_name(endpoint.msg_type),
        "reliability": qos.reliability.name,
        "durability": qos.durability.name,
        "matched": matched,
    }


def type_name(kind: Any) -> str:
    """Return the ROS type of a class of messages, such as `geometry_msgs/msg/Twist`."""
    return f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"


def qos_can_match(kind: str, reliability: str, durability: str, kept: bool = False, **_: Any) -> bool:
    """Return whether an endpoint's QoS is compatible with the grader's: reliable and, unless `kept`, volatile.

    A best-effort publisher does not match a reliable subscription, nor a transient-local subscription a volatile
    publisher.

    Source: ROS 2 documentation, "Quality of Service settings", section "QoS compatibilities".
    """
    return reliability != "BEST_EFFORT" if kind == "publisher" else kept or durability != "TRANSIENT_LOCAL"
