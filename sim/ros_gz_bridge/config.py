"""Reads bridges from a YAML file or from the command line and says exactly what is wrong with them.

The syntax is ros_gz_bridge's own; ``parameter_bridge`` hands the entries to ``bridge.Bridge``. What the
original passes over in silence (a misspelt key, a type nobody converts, an argument without direction) is an
error here, with file and line, and all errors of a file are listed at once.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import yaml

from gz.transport import naming
from ros_gz_bridge.entry import BridgeEntry, Direction
from ros_gz_bridge.type_pairs import UnknownPairError, canonical_gz_type, find_pair, pairs

MAX_BYTES = 256 * 1024
"""Largest YAML file read, in bytes."""
MAX_ENTRIES = 1000
"""Most bridges one file may hold."""

_MARKS = {"@": Direction.BIDIRECTIONAL, "[": Direction.GZ_TO_ROS, "]": Direction.ROS_TO_GZ}
_KEYS = (
    "topic_name",
    "ros_topic_name",
    "gz_topic_name",
    "ros_type_name",
    "gz_type_name",
    "direction",
    "publisher_queue",
    "subscriber_queue",
    "lazy",
    "frame_id",
)
_SERVICE_KEYS = ("service_name", "gz_req_type_name", "gz_rep_type_name")
_ROS_TOKEN = r"(?:[A-Za-z_]|\{\w+\})(?:\w|\{\w+\})*"
_ROS_NAME = re.compile(rf"(?:~|(?:~/|/)?{_ROS_TOKEN}(?:/{_ROS_TOKEN})*)", re.ASCII)
_SYNTAX = "TOPIC@ROS_TYPE@GZ_TYPE, with [ (Gazebo to ROS) or ] (ROS to Gazebo) in place of the second @"


class ConfigError(ValueError):
    """One or more faults in a configuration; ``errors`` holds one sentence for each, with its place."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))


def load_yaml(path: str | Path, *, lazy: bool = False) -> list[BridgeEntry]:
    """The entries of a YAML file. Raises ``ConfigError`` listing every fault in it.

    ``lazy`` holds for the entries that do not say.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise ConfigError([f"{path}: cannot read the bridge configuration: {error.strerror}"]) from None
    return parse_yaml(data, str(path), lazy=lazy)


def parse_yaml(text: str | bytes, file_name: str = "<string>", *, lazy: bool = False) -> list[BridgeEntry]:
    """As ``load_yaml``, for a text; ``file_name`` stands in the error sentences."""
    if len(text) > MAX_BYTES:
        raise ConfigError([f"{file_name}: larger than {MAX_BYTES // 1024} KiB, which no bridge configuration needs"])
    root = _compose(text, file_name)
    if root is None or (isinstance(root, yaml.ScalarNode) and root.tag.endswith(":null")):
        raise ConfigError([f"{file_name}: the file is empty; expected a list of bridges, each starting with '- '"])
    if not isinstance(root, yaml.SequenceNode):
        raise ConfigError(
            [f"{_place(file_name, root)}: expected a list of bridges, found {_kind(root)}; start each bridge with '- '"]
        )
    if len(root.value) > MAX_ENTRIES:
        raise ConfigError([f"{file_name}: {len(root.value)} bridges, more than the {MAX_ENTRIES} a file may hold"])
    errors: list[str] = []
    entries = [
        entry for node in root.value if (entry := _EntryReader(file_name, node, errors, lazy).read()) is not None
    ]
    errors.extend(_repeated(entries))
    if errors:
        raise ConfigError(errors)
    return entries


def parse_argument(text: str) -> BridgeEntry:
    """The entry written as ``TOPIC@ROS_TYPE@GZ_TYPE`` (or ``[``, ``]``). Raises ``ConfigError``."""
    where = f"argument '{text}'"
    if re.search(r"@[^@\[\]]*/srv/", text):
        raise ConfigError([f"{where}: bridges a service; only topics can be bridged here"])
    match = re.fullmatch(r"([^@]*)@([^@\[\]]*)(?:([@\[\]])(.*))?", text)
    if match is None:
        raise ConfigError([f"{where}: has no '@'; expected {_SYNTAX}"])
    topic, ros_type, mark, gz_type = match.groups()
    errors: list[str] = []
    if not topic:
        errors.append(f"{where}: the topic name before the first '@' is missing; expected {_SYNTAX}")
    else:
        name_fault = _ros_name_fault(topic) or _gz_name_fault(topic)
        errors.extend([f"{where}: {name_fault}"] if name_fault else [])
    if mark is None:
        example = _partner(ros_type)
        errors.append(
            f"{where}: has no direction and no Gazebo type; expected {_SYNTAX}, for instance "
            f"{topic}@{ros_type}@{example}"
        )
    else:
        errors.extend(f"{where}: {fault}" for fault in _type_faults(ros_type, gz_type))
    if errors:
        raise ConfigError(errors)
    return BridgeEntry(topic, topic, ros_type, canonical_gz_type(gz_type), _MARKS[mark], source=where)


def parse_arguments(texts: Iterable[str]) -> list[BridgeEntry]:
    """The entries of several arguments. Raises ``ConfigError`` listing the faults of all of them."""
    entries: list[BridgeEntry] = []
    errors: list[str] = []
    for text in texts:
        try:
            entries.append(parse_argument(text))
        except ConfigError as error:
            errors.extend(error.errors)
    errors.extend(_repeated(entries))
    if errors:
        raise ConfigError(errors)
    return entries


def _compose(text: str | bytes, file_name: str) -> yaml.Node | None:
    """The node tree with its line numbers; nothing in it is ever built into an object."""
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{file_name}:{mark.line + 1}" if mark else file_name
        raise ConfigError([f"{place}: not valid YAML: {error.problem or error.context}"]) from None
    except yaml.reader.ReaderError as error:
        raise ConfigError([f"{file_name}: not a YAML text: {error.reason} at position {error.position}"]) from None
    except RecursionError:
        raise ConfigError([f"{file_name}: nested too deeply for a bridge configuration"]) from None
    except ValueError as error:
        raise ConfigError([f"{file_name}: not valid YAML: {error}"]) from None


class _EntryReader:
    """Reads one item of the list, adding what is wrong with it to ``errors``."""

    def __init__(self, file_name: str, node: yaml.Node, errors: list[str], lazy: bool) -> None:
        self._file_name = file_name
        self._node = node
        self._all_errors = errors
        self._lazy = lazy
        self._errors: list[str] = []
        self._values: dict[str, yaml.Node] = {}

    def read(self) -> BridgeEntry | None:
        """The entry, or None if anything is wrong with it."""
        if not isinstance(self._node, yaml.MappingNode):
            self._wrong(self._node, f"expected a bridge (lines of 'key: value'), found {_kind(self._node)}")
        else:
            self._collect(self._node)
            service = next((key for key in _SERVICE_KEYS if key in self._values), None)
            if service is not None:
                self._wrong(self._values[service], f"'{service}' bridges a service; only topics can be bridged here")
            else:
                entry = self._entry()
                if not self._errors:
                    return entry
        self._all_errors.extend(self._errors)
        return None

    def _collect(self, node: yaml.MappingNode) -> None:
        first_line: dict[str, int] = {}
        for key_node, value in node.value:
            key = key_node.value if isinstance(key_node, yaml.ScalarNode) else None
            if key is None or key not in (*_KEYS, *_SERVICE_KEYS):
                self._wrong(key_node, _unknown_key(key))
            elif key in first_line:
                self._wrong(key_node, f"'{key}' is given twice (first in line {first_line[key]}); keep one")
            else:
                first_line[key] = key_node.start_mark.line + 1
                self._values[key] = value

    def _entry(self) -> BridgeEntry | None:
        ros_topic, gz_topic = self._topics()
        ros_type, gz_type = self._text("ros_type_name"), self._text("gz_type_name")
        for key in ("ros_type_name", "gz_type_name"):
            if key not in self._values:
                self._wrong(self._node, f"'{key}' is missing; a bridge needs both ros_type_name and gz_type_name")
        if ros_type and gz_type:
            for fault in _type_faults(ros_type, gz_type):
                self._wrong(self._values["ros_type_name"], fault)
        direction = self._direction()
        publisher_queue, subscriber_queue = self._depth("publisher_queue"), self._depth("subscriber_queue")
        lazy = self._flag("lazy", self._lazy)
        frame_id = self._text("frame_id") if "frame_id" in self._values else None
        if self._errors or ros_topic is None or gz_topic is None or ros_type is None or gz_type is None:
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
            source=_place(self._file_name, self._node),
        )

    def _topics(self) -> tuple[str | None, str | None]:
        both = "topic_name" in self._values
        sides = [key for key in ("ros_topic_name", "gz_topic_name") if key in self._values]
        if both and sides:
            self._wrong(
                self._values["topic_name"],
                f"'topic_name' and '{sides[0]}' exclude each other; give topic_name alone for one name on "
                "both sides, or ros_topic_name and gz_topic_name",
            )
            return None, None
        if not both and not sides:
            self._wrong(self._node, "the topic is missing; give topic_name, or ros_topic_name and gz_topic_name")
            return None, None
        ros_key, gz_key = ("topic_name", "topic_name") if both else (sides[0], sides[-1])
        ros_topic = self._text(ros_key)
        gz_topic = ros_topic if gz_key == ros_key else self._text(gz_key)
        ros_fault = _ros_name_fault(ros_topic) if ros_topic else None
        gz_fault = _gz_name_fault(gz_topic) if gz_topic else None
        if ros_fault:
            self._wrong(self._values[ros_key], ros_fault)
        if gz_fault and not (ros_fault and gz_key == ros_key):
            self._wrong(self._values[gz_key], gz_fault)
        return ros_topic, gz_topic

    def _direction(self) -> Direction:
        text = self._text("direction") if "direction" in self._values else Direction.BIDIRECTIONAL.value
        if text is None:
            return Direction.BIDIRECTIONAL
        words = [direction.value for direction in Direction]
        if text not in words:
            guess = _nearest(text.upper(), words)
            self._wrong(
                self._values["direction"],
                f"the direction '{text}' is none of {', '.join(words)}{guess}",
            )
            return Direction.BIDIRECTIONAL
        return Direction(text)

    def _text(self, key: str) -> str | None:
        node = self._values.get(key)
        if node is None:
            return None
        if not isinstance(node, yaml.ScalarNode) or node.tag.endswith(":null") or not node.value:
            self._wrong(node, f"'{key}' must be a text, not {_kind(node)}")
            return None
        return str(node.value)

    def _depth(self, key: str) -> int:
        node = self._values.get(key)
        if node is None:
            return 10
        if not isinstance(node, yaml.ScalarNode) or not re.fullmatch(r"0*[1-9]\d{0,5}", node.value, re.ASCII):
            seen = node.value if isinstance(node, yaml.ScalarNode) and node.value else _kind(node)
            self._wrong(node, f"'{key}' must be a number of messages from 1 to 999999, not {seen}")
            return 10
        return int(node.value)

    def _flag(self, key: str, default: bool) -> bool:
        node = self._values.get(key)
        if node is None:
            return default
        if not isinstance(node, yaml.ScalarNode) or not node.tag.endswith(":bool"):
            seen = node.value if isinstance(node, yaml.ScalarNode) and node.value else _kind(node)
            self._wrong(node, f"'{key}' must be true or false, not {seen}")
            return False
        return node.value.lower() in ("true", "yes", "on")

    def _wrong(self, node: yaml.Node, sentence: str) -> None:
        self._errors.append(f"{_place(self._file_name, node)}: {sentence}")


def _place(file_name: str, node: yaml.Node) -> str:
    return f"{file_name}:{node.start_mark.line + 1}"


def _kind(node: yaml.Node) -> str:
    if isinstance(node, yaml.MappingNode):
        return "a mapping ('key: value')"
    if isinstance(node, yaml.SequenceNode):
        return "a list"
    return "nothing" if node.tag.endswith(":null") or not node.value else f"the text '{node.value[:60]}'"


def _unknown_key(key: str | None) -> str:
    if key is None:
        return f"a key must be one of {', '.join(_KEYS)}"
    guess = _nearest(key, (*_KEYS, *_SERVICE_KEYS))
    return f"the key '{key}' is not known{guess or '; known keys: ' + ', '.join(_KEYS)}"


def _nearest(word: str, words: Iterable[str]) -> str:
    close = difflib.get_close_matches(word, list(words), n=1)
    return f"; did you mean {close[0]}?" if close else ""


def _partner(ros_type: str) -> str:
    """The Gazebo type usually meant with ``ros_type``, for an example in a sentence."""
    return next((pair.gz_type for pair in pairs() if pair.ros_type == ros_type), "gz.msgs.StringMsg")


def _type_faults(ros_type: str, gz_type: str) -> Iterator[str]:
    if not gz_type:
        yield "the Gazebo type after the direction mark is missing"
    elif re.search(r"[@\[\]]", gz_type):
        yield f"'{gz_type}' is not a Gazebo type; one direction mark is enough"
    else:
        try:
            find_pair(ros_type, gz_type)
        except UnknownPairError as error:
            yield str(error)


def _ros_name_fault(name: str) -> str | None:
    if _ROS_NAME.fullmatch(name) and "__" not in name:
        return None
    return (
        f"'{name}' is not a ROS topic name; use letters, digits, '_' and '/', no part starting with a digit, "
        "no '//' or '__', and no '/' at the end"
    )


def _gz_name_fault(name: str) -> str | None:
    rule = naming.broken_rule(name, may_be_empty=False)
    return f"'{name}' is not a Gazebo topic name: it {rule}" if rule else None


def _repeated(entries: list[BridgeEntry]) -> Iterator[str]:
    """Two entries that would carry the same message over the same route twice."""
    seen: dict[tuple[Any, ...], BridgeEntry] = {}
    for entry in entries:
        for way, used in (("ros", entry.direction.to_ros), ("gz", entry.direction.to_gz)):
            if not used:
                continue
            first = seen.setdefault((way, *entry.same_route), entry)
            if first is not entry:
                yield f"{entry.source}: bridges {entry.ros_topic} again (first: {first.source}); keep one"
                break
