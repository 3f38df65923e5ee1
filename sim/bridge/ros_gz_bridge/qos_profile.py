"""The QoS profiles that an entry may name with `qos_profile`, and the QoS of its endpoints.

Source: README.md of ros_gz_bridge (names); rmw/qos_profiles.h, and rclcpp/qos.hpp for ClockQoS and RosoutQoS (policies)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile


@dataclass(frozen=True)
class _Policies:
    depth: int
    reliability: str = "RELIABLE"
    durability: str = "VOLATILE"
    lifespan_s: int = 0
    best_available: bool = False


QOS_PROFILES = {
    "CLOCK": _Policies(1, "BEST_EFFORT"),
    "SENSOR_DATA": _Policies(5, "BEST_EFFORT"),
    "PARAMETERS": _Policies(1000),
    "SERVICES": _Policies(10),
    "PARAMETER_EVENTS": _Policies(1000),
    "ROSOUT": _Policies(1000, "RELIABLE", "TRANSIENT_LOCAL", lifespan_s=10),
    "SYSTEM_DEFAULT": _Policies(1, "SYSTEM_DEFAULT", "SYSTEM_DEFAULT"),
    "BEST_AVAILABLE": _Policies(10, "BEST_AVAILABLE", "BEST_AVAILABLE", best_available=True),
}
DEFAULT_DEPTH = 10
PUBLISHER_POLICIES = ("deadline", "depth", "durability", "history", "liveliness", "reliability")
"""The policies that `qos_overrides` may set for a publisher."""


def depth_of(profile: str | None) -> int:
    """Return the depth [messages] of a profile, for entries without one."""
    return QOS_PROFILES[profile].depth if profile else DEFAULT_DEPTH


def reliable(profile: str | None) -> bool:
    """Return whether publishers with a profile are reliable."""
    return profile is None or QOS_PROFILES[profile].reliability == "RELIABLE"


def qos(profile: str | None, depth: int) -> QoSProfile:
    """Return the QoS of an endpoint: that of the profile (None: reliable, volatile), with `depth` [messages]."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

    if profile is None:
        return QoSProfile(depth=depth)
    policies = QOS_PROFILES[profile]
    chosen = QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy[policies.reliability],
        durability=DurabilityPolicy[policies.durability],
    )
    if policies.lifespan_s:
        chosen.lifespan = Duration(seconds=policies.lifespan_s)
    if policies.best_available:
        chosen.liveliness = LivelinessPolicy.BEST_AVAILABLE
    return chosen
