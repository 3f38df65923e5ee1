"""The reader of one entry from keys and values, which come from a YAML file or from ROS parameters.

The keys of the YAML file and of the parameters `bridges.<name>.<key>` are the same. `config` and `parameters` pass each
value as a `Value` with its place.

Source: README.md and src/bridge_config.cpp of ros_gz_bridge, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction, ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.finding import Finding
from gz_course.sim.bridge.ros_gz_bridge.names import gz_name_fault, ros_name_fault
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import QOS_PROFILES, depth_of
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import (
    UnknownPairError,
    canonical_gz_type,
    find_pair,
    find_service,
    missing_packages,
)
from gz_course.sim.did_you_mean import did_you_mean

_NAMES = ("topic_name", "ros_topic_name", "gz_topic_name", "ros_type_name", "gz_type_name")
KEYS = (*_NAMES, "direction", "publisher_queue", "subscriber_queue", "lazy", "qos_profile", "frame_id")
"""The keys of a topic."""
SERVICE_KEYS = ("service_name", "ros_type_name", "gz_req_type_name", "gz_rep_type_name")
"""The keys of a service."""
_OF_SERVICES_ONLY = tuple(key for key in SERVICE_KEYS if key not in KEYS)
MISSING = "is missing"  # what a sentence says of a key that a bridge needs
_WRONG_PREFIXES = ("gz_msgs.", "ign_msgs.")
_OLD_PREFIX = "ignition.msgs."
_TRUE, _FALSE = ("true", "yes", "on", "y"), ("false", "no", "off", "n")


@dataclass(frozen=True)
class Value:
    """One value as it was written: its place, `kind` (text, bool, int, float, null or structure) and text.

    `shown` is its description for error sentences. The text of a structure is empty.
    """

    place: str
    kind: str
    text: str
    shown: str

    @property
    def is_scalar(self) -> bool:
        """Whether it is a single value and not empty."""
        return self.kind in ("text", "bool", "int", "float") and bool(self.text)


class EntryReader:
    """The reader of one entry; adds its faults to `findings`. `lazy` is the default of that key."""

    def __init__(self, place: str, values: Mapping[str, Value], findings: list[Finding], lazy: bool = False) -> None:
        self._place = place
        self._values = values
        self._all_findings = findings
        self._findings: list[Finding] = []
        self._lazy = lazy

    def read(self) -> BridgeEntry | ServiceEntry | None:
        """Return the entry, or None if it has a fault that the original ros_gz_bridge does not ignore."""
        service = any(key in self._values for key in _OF_SERVICES_ONLY)
        entry = self._service() if service else self._topic()
        broken = any(not (finding.warning or finding.tolerated) for finding in self._findings)
        if any(not (finding.warning or finding.tolerated or finding.fatal) for finding in self._findings):
            # The original leaves this entry out before it comes to the fault at which it would end.
            self._findings = [replace(finding, fatal=False) for finding in self._findings]
        self._all_findings.extend(self._findings)
        return None if broken else entry

    def _topic(self) -> BridgeEntry | None:
        ros_topic, gz_topic = self._topics()
        ros_type, gz_type = self._text("ros_type_name"), self._text("gz_type_name")
        for key in ("ros_type_name", "gz_type_name"):
            if key not in self._values:
                self._wrong(None, f"'{key}' {MISSING}; a bridge needs both ros_type_name and gz_type_name")
        if ros_type and gz_type:
            self._types(ros_type, gz_type)
        direction = self._direction()
        profile = self._profile()
        publisher_queue = self._depth("publisher_queue", depth_of(profile))
        subscriber_queue = self._depth("subscriber_queue", depth_of(profile))
        lazy = self._flag("lazy", self._lazy)
        frame_id = self._text("frame_id") if "frame_id" in self._values else None
        self._without_effect(direction, frame_id)
        if not (ros_topic and gz_topic and ros_type and gz_type):
            return None
        return BridgeEntry(
            ros_topic,
            gz_topic,
            ros_type,
            canonical_gz_type(gz_type),
            direction,
            publisher_queue,
            subscriber_queue,
            lazy,
            frame_id,
            source=self._place,
            qos_profile=profile,
        )

    def _service(self) -> ServiceEntry | None:
        for key in self._values:
            if key not in SERVICE_KEYS:
                self._wrong(key, f"'{key}' is for a topic, but this entry is a service; make two entries of it")
        for key in SERVICE_KEYS:
            if key not in self._values:
                self._wrong(None, f"'{key}' is missing; a service needs {', '.join(SERVICE_KEYS)}")
        name, ros_type, request, reply = (self._text(key) for key in SERVICE_KEYS)
        if name and (fault := ros_name_fault(name) or gz_name_fault(name)):
            self._wrong("service_name", fault, fatal=ros_name_fault(name) is not None)
        if not (name and ros_type and request and reply):
            return None
        for fault in service_type_faults(ros_type, request, reply):
            self._wrong("ros_type_name", fault, advice=_not_installed(ros_type))
        return ServiceEntry(name, ros_type, canonical_gz_type(request), canonical_gz_type(reply), self._place)

    def _types(self, ros_type: str, gz_type: str) -> None:
        for fault in type_faults(ros_type, gz_type):
            self._wrong("ros_type_name", fault, advice=_not_installed(ros_type))
        if warning := old_type_warning(gz_type):
            self._advise("gz_type_name", warning)

    def _topics(self) -> tuple[str | None, str | None]:
        both = self._has("topic_name")
        sides = [key for key in ("ros_topic_name", "gz_topic_name") if self._has(key)]
        if both and sides:
            self._wrong(
                "topic_name",
                f"'topic_name' and '{sides[0]}' exclude each other; give topic_name alone for one name on "
                "both sides, or ros_topic_name and gz_topic_name",
            )
            return None, None
        if not both and not sides:
            self._wrong(None, f"the topic {MISSING}; give topic_name, or ros_topic_name and gz_topic_name", fatal=True)
            return None, None
        ros_key, gz_key = ("topic_name", "topic_name") if both else (sides[0], sides[-1])
        ros_topic = self._text(ros_key)
        gz_topic = ros_topic if gz_key == ros_key else self._text(gz_key)
        ros_fault = ros_name_fault(ros_topic) if ros_topic else None
        gz_fault = gz_name_fault(gz_topic) if gz_topic else None
        if ros_fault:
            self._wrong(ros_key, ros_fault, fatal=True)
        if gz_fault and not (ros_fault and gz_key == ros_key):
            self._wrong(gz_key, gz_fault)
        return ros_topic, gz_topic

    def _has(self, key: str) -> bool:
        """Return whether the key of a name is given; an empty text counts as missing."""
        value = self._values.get(key)
        if value is None or value.kind != "text" or value.text:
            return value is not None
        self._wrong(key, f"'{key}' must be a text, not nothing; leave the key out", tolerated=True)
        return False

    def _direction(self) -> Direction:
        text = self._text("direction") if "direction" in self._values else Direction.BIDIRECTIONAL.value
        if text is None:
            return Direction.BIDIRECTIONAL
        words = [direction.value for direction in Direction]
        if text not in words:
            guess = did_you_mean(text, words)
            self._wrong("direction", f"the direction '{text}' is none of {', '.join(words)}{guess}")
            return Direction.BIDIRECTIONAL
        return Direction(text)

    def _profile(self) -> str | None:
        text = self._text("qos_profile") if "qos_profile" in self._values else None
        if text is None:
            return None
        if text not in QOS_PROFILES:
            guess = did_you_mean(text, QOS_PROFILES)
            sentence = f"the QoS profile '{text}' is none of {', '.join(QOS_PROFILES)}{guess}"
            self._wrong("qos_profile", sentence, tolerated=True)
            return None
        self._warn(
            "qos_profile",
            "'qos_profile' is known to newer releases than Jazzy only, where ros_gz_bridge passes over it; "
            "the parameters qos_overrides./TOPIC.publisher.* work in both",
        )
        return text

    def _text(self, key: str) -> str | None:
        value = self._values.get(key)
        if value is None:
            return None
        if not value.is_scalar:
            newer = key in ("qos_profile", "frame_id")  # keys that the original of Jazzy does not read
            sentence = f"'{key}' must be a text, not {value.shown}"
            self._wrong(key, sentence, tolerated=newer, fatal=value.kind == "structure" and not newer)
            return None
        return value.text

    def _depth(self, key: str, default: int) -> int:
        value = self._values.get(key)
        if value is None:
            return default
        if value.is_scalar and re.fullmatch(r"-0*[1-9]\d{0,5}", value.text, re.ASCII):
            self._warn(key, f"'{key}' below 0 means the default depth to newer releases than Jazzy; leave it out")
            return default
        if not value.is_scalar or not re.fullmatch(r"0*[1-9]\d{0,5}", value.text, re.ASCII):
            zero = value.is_scalar and re.fullmatch("0+", value.text, re.ASCII) is not None
            sentence = f"'{key}' must be a number of messages from 1 to 999999, not {value.text or value.shown}"
            self._wrong(key, sentence, tolerated=zero, fatal=not zero)
            return default
        return int(value.text)

    def _flag(self, key: str, default: bool) -> bool:
        value = self._values.get(key)
        if value is None:
            return default
        if value.kind != "bool":
            known = value.kind == "text" and value.text.lower() in (*_TRUE, *_FALSE)
            sentence = f"'{key}' must be true or false, not {value.text or value.shown}"
            self._wrong(key, sentence, tolerated=known, fatal=not known)
        return value.text.lower() in _TRUE

    def _without_effect(self, direction: Direction, frame_id: str | None) -> None:
        if "publisher_queue" in self._values and not direction.to_ros:
            self._advise(
                "publisher_queue", "'publisher_queue' changes nothing here: this bridge does not publish to ROS"
            )
        if "subscriber_queue" in self._values and not direction.to_gz:
            self._advise(
                "subscriber_queue", "'subscriber_queue' changes nothing here: this bridge does not subscribe in ROS"
            )
        if frame_id and not direction.to_ros:
            self._advise("frame_id", "'frame_id' changes nothing here: it is for messages that go to ROS")

    def _wrong(self, key: str | None, sentence: str, **marks: bool) -> None:
        self._findings.append(Finding(self._values[key].place if key else self._place, sentence, **marks))

    def _warn(self, key: str, sentence: str) -> None:
        self._findings.append(Finding(self._values[key].place, sentence, warning=True))

    def _advise(self, key: str, sentence: str) -> None:
        self._findings.append(Finding(self._values[key].place, sentence, warning=True, advice=True))


def _not_installed(ros_type: str) -> bool:
    return ros_type.partition("/")[0] in missing_packages()


def unknown_key(key: str | None) -> str:
    """Return the sentence about a key that does not exist."""
    if key is None:
        return f"a key must be one of {', '.join(KEYS)}"
    if key == "<<":
        return "'<<' merges nothing in a bridge's file (ros_gz_bridge reads it with yaml-cpp); write the keys out"
    guess = did_you_mean(key, (*KEYS, *_OF_SERVICES_ONLY))
    return f"the key '{key}' is not known{guess or '; known keys: ' + ', '.join(KEYS)}"


def type_faults(ros_type: str, gz_type: str) -> Iterator[str]:
    """Yield why the two types of a topic cannot be bridged."""
    if not gz_type:
        yield "the Gazebo type after the direction mark is missing"
    elif re.search(r"[@\[\]]", gz_type):
        yield f"'{gz_type}' is not a Gazebo type; one direction mark is enough"
    elif gz_type.startswith(_WRONG_PREFIXES):
        yield f"'{gz_type}' is not a Gazebo type; write {canonical_gz_type(gz_type)}"
    else:
        try:
            find_pair(ros_type, gz_type)
        except UnknownPairError as error:
            yield str(error)


def service_type_faults(ros_type: str, gz_request_type: str, gz_reply_type: str) -> Iterator[str]:
    """Yield why the types of a service cannot be bridged."""
    try:
        find_service(ros_type, gz_request_type, gz_reply_type)
    except UnknownPairError as error:
        yield str(error)


def old_type_warning(gz_type: str) -> str | None:
    """Return the warning about a Gazebo type in the spelling of Gazebo Fortress, or None."""
    if gz_type.startswith(_OLD_PREFIX):
        return f"'{gz_type}' is the old spelling, which newer releases than Jazzy do not know; write " + (
            canonical_gz_type(gz_type)
        )
    return None
