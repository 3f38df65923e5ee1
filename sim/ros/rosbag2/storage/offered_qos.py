"""The QoS profiles that are stored in bags, as plain values.

Up to version 8 of the metadata a list of profiles is a text with numbers for policies; since version 9 policies are
words.

Source: rosbag2_storage 0.26 (`qos.cpp`); rmw 7.3 (`types.h`, `qos_string_conversions.c`) for numbers and words
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.yaml_text import load_yaml

INFINITE = (9223372036, 854775807)
"""Seconds and nanoseconds of a duration without an end."""
_INFINITE_IN_FOXY = {(0x7FFFFFFF, 0xFFFFFFFF), (0x7FFFFFFF, 0x7FFFFFFF)}
_WORDS = {
    "history": ("system_default", "keep_last", "keep_all", "unknown"),
    "reliability": ("system_default", "reliable", "best_effort", "unknown", "best_available"),
    "durability": ("system_default", "transient_local", "volatile", "unknown", "best_available"),
    "liveliness": ("system_default", "automatic", "manual_by_node", "manual_by_topic", "unknown", "best_available"),
}
_DURATIONS = ("deadline", "lifespan", "liveliness_lease_duration")
DEPTH = 10


@dataclass(frozen=True)
class QosProfile:
    """A profile; durations are seconds and nanoseconds."""

    history: str = "keep_last"
    depth: int = DEPTH
    reliability: str = "reliable"
    durability: str = "volatile"
    deadline: tuple[int, int] = INFINITE
    lifespan: tuple[int, int] = INFINITE
    liveliness: str = "automatic"
    liveliness_lease_duration: tuple[int, int] = INFINITE
    avoid_ros_namespace_conventions: bool = False

    def as_dictionary(self) -> dict[str, Any]:
        values: dict[str, Any] = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return values | {name: dict(zip(("sec", "nsec"), values[name], strict=True)) for name in _DURATIONS}


def profiles_from_yaml(value: Any, name: str) -> tuple[QosProfile, ...]:
    """Read a list of profiles, or a text that holds one; `name` is the file. Raises BagError."""
    if isinstance(value, str):
        value = load_yaml(value, name) if value.strip() else []
    if value is None:
        return ()
    if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
        raise BagError(f"{name}: 'offered_qos_profiles' must be a list of QoS profiles")
    return tuple(_profile(each, name) for each in value)


def _profile(values: dict[str, Any], name: str) -> QosProfile:
    found: dict[str, Any] = {}
    for key, words in _WORDS.items():
        value = values.get(key, getattr(QosProfile, key))
        if isinstance(value, int) and 0 <= value < len(words):
            value = words[value]
        if value not in words:
            raise BagError(f"{name}: the QoS policy '{key}' cannot be {str(value)[:80]!r}")
        found[key] = value
    depth = values.get("depth", DEPTH)
    if not isinstance(depth, int) or not 0 <= depth < 2**63:
        raise BagError(f"{name}: the depth of a QoS profile cannot be {str(depth)[:80]!r}")
    found["depth"] = depth
    for key in _DURATIONS:
        found[key] = _duration(values.get(key), key, name)
    found["avoid_ros_namespace_conventions"] = values.get("avoid_ros_namespace_conventions") is True
    return QosProfile(**found)


def _duration(value: Any, key: str, name: str) -> tuple[int, int]:
    if value is None:
        return INFINITE
    parts = (value.get("sec"), value.get("nsec")) if isinstance(value, dict) else (None, None)
    seconds, nanoseconds = parts
    if not isinstance(seconds, int) or not isinstance(nanoseconds, int) or seconds < 0 or nanoseconds < 0:
        raise BagError(f"{name}: '{key}' of a QoS profile must have whole numbers 'sec' and 'nsec'")
    if (seconds, nanoseconds) in _INFINITE_IN_FOXY or seconds * 10**9 + nanoseconds >= 2**63 - 1:
        return INFINITE
    return seconds, nanoseconds


def offer_like(profiles: tuple[QosProfile, ...]) -> tuple[QosProfile, bool]:
    """Return the profile to publish with, and whether the recorded publishers agreed on it.

    History and lifespan do not decide who hears whom.
    """
    if not profiles:
        return QosProfile(), True
    plain = {replace(each, history="keep_last", depth=DEPTH, lifespan=INFINITE) for each in profiles}
    if len(plain) > 1:
        return QosProfile(), False
    return replace(profiles[0], history="keep_last", depth=max(DEPTH, min(profiles[0].depth, 1000))), True
