"""What a bag knows of itself: `metadata.yaml`, and the same text within an MCAP file.

Source: rosbag2_storage 0.26, https://github.com/ros2/rosbag2 (`yaml.hpp`, `bag_metadata.hpp`): keys, and what came with
which version
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.offered_qos import QosProfile, profiles_from_yaml
from gz_course.sim.ros.rosbag2.storage.yaml_text import load_yaml, to_yaml

VERSION = 9
FILE = "metadata.yaml"
DISTRO = "jazzy"
_ROOT = "rosbag2_bagfile_information"
_LONGEST = 64 * 1024 * 1024  # bytes of a file that can be one of these


@dataclass(frozen=True)
class Topic:
    """A topic of a bag; `qos` are the profiles that its publishers offered."""

    name: str
    type: str
    serialization_format: str = "cdr"
    qos: tuple[QosProfile, ...] = ()
    type_hash: str = ""


@dataclass
class FileInformation:
    """One file of a bag, with its times [ns]."""

    path: str
    start: int = 0
    duration: int = 0
    count: int = 0


@dataclass
class Metadata:
    """A bag as a whole; times [ns], `counts` are the messages of each topic by its name."""

    storage: str
    topics: list[Topic] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    files: list[FileInformation] = field(default_factory=list)
    start: int = 0
    duration: int = 0
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    distro: str = DISTRO
    version: int = VERSION

    @property
    def count(self) -> int:
        return sum(self.counts.values())

    def as_dictionary(self) -> dict[str, Any]:
        """Return the content of `metadata.yaml` below its root."""
        return {
            "version": VERSION,
            "storage_identifier": self.storage,
            "duration": {"nanoseconds": self.duration},
            "starting_time": {"nanoseconds_since_epoch": self.start},
            "message_count": self.count,
            "topics_with_message_count": [
                {
                    "topic_metadata": {
                        "name": topic.name,
                        "type": topic.type,
                        "serialization_format": topic.serialization_format,
                        "offered_qos_profiles": [profile.as_dictionary() for profile in topic.qos],
                        "type_description_hash": topic.type_hash,
                    },
                    "message_count": self.counts.get(topic.name, 0),
                }
                for topic in self.topics
            ],
            "compression_format": self.compression_format,
            "compression_mode": self.compression_mode,
            "relative_file_paths": [file.path for file in self.files],
            "files": [
                {
                    "path": file.path,
                    "starting_time": {"nanoseconds_since_epoch": file.start},
                    "duration": {"nanoseconds": file.duration},
                    "message_count": file.count,
                }
                for file in self.files
            ],
            "custom_data": self.custom_data or None,
            "ros_distro": self.distro,
        }

    def as_yaml(self) -> str:
        """Return the text of `metadata.yaml`."""
        return to_yaml({_ROOT: self.as_dictionary()})


def from_yaml(text: str, name: str) -> Metadata:
    """Read the text of the file `name`. Raises BagError."""
    if len(text) > _LONGEST:
        raise BagError(f"{name} is too long for the metadata of a bag: {len(text)} characters")
    whole = load_yaml(text, name)
    if not isinstance(whole, dict) or not isinstance(whole.get(_ROOT), dict):
        raise BagError(f"{name} has no '{_ROOT}': it is not the metadata of a bag")
    return from_dictionary(whole[_ROOT], name)


def from_dictionary(values: dict[str, Any], name: str) -> Metadata:
    """Read what is below the root. Raises BagError, which names the key."""
    read = _Reader(name)
    version = read.number(values, "version")
    if version > VERSION:
        raise BagError(f"{name} has version {version}, which is newer than {VERSION}, the newest that is known here")
    metadata = Metadata(
        storage=read.text(values, "storage_identifier"),
        start=read.nested_number(values, "starting_time", "nanoseconds_since_epoch"),
        duration=read.nested_number(values, "duration", "nanoseconds"),
        version=version,
        compression_format=read.text(values, "compression_format", ""),
        compression_mode=read.text(values, "compression_mode", "").lower().replace("none", ""),
        distro=read.text(values, "ros_distro", "unknown"),
    )
    for entry in read.list_of_dictionaries(values, "topics_with_message_count"):
        about = entry.get("topic_metadata")
        if not isinstance(about, dict):
            raise BagError(f"{name}: a topic has no 'topic_metadata'")
        topic = Topic(
            name=read.text(about, "name"),
            type=read.text(about, "type"),
            serialization_format=read.text(about, "serialization_format", "cdr"),
            qos=profiles_from_yaml(about.get("offered_qos_profiles") or "", name),
            type_hash=read.text(about, "type_description_hash", ""),
        )
        metadata.topics.append(topic)
        metadata.counts[topic.name] = read.number(entry, "message_count")
    paths = values.get("relative_file_paths")
    if not isinstance(paths, list) or not all(isinstance(path, str) for path in paths):
        raise BagError(f"{name}: 'relative_file_paths' must be a list of file names")
    known = {}
    for entry in read.list_of_dictionaries(values, "files") if "files" in values else ():
        known[read.text(entry, "path")] = FileInformation(
            read.text(entry, "path"),
            read.nested_number(entry, "starting_time", "nanoseconds_since_epoch"),
            read.nested_number(entry, "duration", "nanoseconds"),
            read.number(entry, "message_count"),
        )
    metadata.files = [known.get(path, FileInformation(path)) for path in paths]
    custom = values.get("custom_data")
    if isinstance(custom, dict):
        metadata.custom_data = {str(key): str(value) for key, value in custom.items()}
    return metadata


class _Reader:
    """Takes values out of dictionaries; the error says which key of which file is wrong."""

    def __init__(self, name: str) -> None:
        self._name = name

    def _value(self, values: dict[str, Any], key: str, fits: Callable[[Any], bool], what: str, default: Any) -> Any:
        value = values.get(key, default)
        if not fits(value):
            seen = "it is missing" if value is None else f"found {str(value)[:80]!r}"
            raise BagError(f"{self._name}: '{key}' must be {what}; {seen}")
        return value

    def text(self, values: dict[str, Any], key: str, default: str | None = None) -> str:
        return self._value(values, key, lambda value: isinstance(value, str), "a text", default)

    def number(self, values: dict[str, Any], key: str) -> int:
        def fits(value: Any) -> bool:
            return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**64

        return self._value(values, key, fits, "a whole number of at most 64 bits", None)

    def nested_number(self, values: dict[str, Any], key: str, inner: str) -> int:
        return self.number(self._value(values, key, lambda value: isinstance(value, dict), "a mapping", None), inner)

    def list_of_dictionaries(self, values: dict[str, Any], key: str) -> Iterable[dict[str, Any]]:
        def fits(value: Any) -> bool:
            return isinstance(value, list) and all(isinstance(each, dict) for each in value)

        return self._value(values, key, fits, "a list of mappings", None)
