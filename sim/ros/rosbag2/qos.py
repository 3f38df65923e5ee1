"""QoS profiles of rclpy for recording and playing.

Source: rosbag2_storage 0.26 (`qos.cpp`): what a recorder asks for, and what a player offers
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.offered_qos import INFINITE, QosProfile
from gz_course.sim.ros.rosbag2.storage.yaml_text import load_yaml

RECORDING_DEPTH = 1000
"""Messages of a topic that wait while the recorder is busy."""

_POLICIES = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
_DURATIONS = ("deadline", "lifespan", "liveliness_lease_duration")


def stored(qos: Any) -> QosProfile:
    """Return a profile of rclpy as a bag stores it."""
    words = {name: getattr(qos, name).name.lower() for name in _POLICIES}
    durations = {name: divmod(getattr(qos, name).nanoseconds, 10**9) for name in _DURATIONS}
    return QosProfile(
        depth=qos.depth,
        avoid_ros_namespace_conventions=qos.avoid_ros_namespace_conventions,
        **words,
        **durations,
    )


def to_offer(profile: QosProfile) -> Any:
    """Return the profile of rclpy for a stored one; what DDS did not know has its default."""
    policies = {
        name: policy[word.upper()]
        for name, policy in _POLICIES.items()
        if (word := getattr(profile, name)) != "unknown" and word.upper() in policy.__members__
    }
    durations = {
        name: Duration(seconds=value[0], nanoseconds=value[1])
        for name in _DURATIONS
        if (value := getattr(profile, name)) not in (INFINITE, (0, 0))
    }
    policies.setdefault("history", HistoryPolicy.KEEP_LAST)
    return QoSProfile(depth=profile.depth or 10, **policies, **durations)


def request_for(endpoints: list[Any]) -> tuple[Any, str]:
    """Return a profile that hears every publisher, and a warning if that costs something, else an empty text."""
    offers = [endpoint.qos_profile for endpoint in endpoints]
    request = QoSProfile(depth=RECORDING_DEPTH)
    warnings = []
    reliable = [offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers]
    if not all(reliable):
        request.reliability = ReliabilityPolicy.BEST_EFFORT
        if any(reliable):
            warnings.append("some, but not all, publishers are reliable: recorded as best effort")
    latched = [offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers]
    if offers and all(latched):
        request.durability = DurabilityPolicy.TRANSIENT_LOCAL
    elif any(latched):
        warnings.append("some, but not all, publishers are transient local: what was sent before is not recorded")
    return request, "; ".join(warnings)


def overrides(path: Path) -> dict[str, Any]:
    """Read the profiles of a file for `--qos-profile-overrides-path`: topic -> profile. Raises BagError."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BagError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    topics = load_yaml(text, str(path))
    if not isinstance(topics, dict) or not all(isinstance(each, dict) for each in topics.values()):
        raise BagError(f"{path}: expected a mapping of topics to QoS profiles, such as '/chatter: {{depth: 5}}'")
    return {str(topic): _override(values, f"{path}: {topic}") for topic, values in topics.items()}


def _override(values: dict[str, Any], place: str) -> Any:
    chosen: dict[str, Any] = {}
    known = (*_POLICIES, *_DURATIONS, "depth", "avoid_ros_namespace_conventions")
    for key, value in values.items():
        if key not in known:
            raise BagError(f"{place}: unexpected key '{key}' for a QoS profile{did_you_mean(str(key), known)}")
        if key in _POLICIES:
            words = _POLICIES[key].short_keys()
            if value not in words:
                raise BagError(f"{place}: '{key}' cannot be {value!r}{did_you_mean(str(value), words)}")
            chosen[key] = _POLICIES[key].get_from_short_key(value)
        elif key in _DURATIONS:
            parts = (value.get("sec"), value.get("nsec")) if isinstance(value, dict) else (None, None)
            if not all(isinstance(part, int) and part >= 0 for part in parts):
                raise BagError(f"{place}: '{key}' needs both 'sec' and 'nsec', whole numbers of at least 0")
            chosen[key] = Duration(seconds=parts[0], nanoseconds=parts[1])
        elif isinstance(value, int) and value >= 0:
            chosen[key] = bool(value) if key.startswith("avoid") else value
        else:
            raise BagError(f"{place}: '{key}' cannot be {value!r}; expected a whole number of at least 0")
    chosen.setdefault("depth", 10)
    return QoSProfile(**chosen)
