"""Options of readers and writers, and what a bag tells of itself."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field
from typing import Any

from rclpy.duration import Duration
from rclpy.time import Time

from gz_course.sim.ros.rosbag2.storage.metadata import Metadata, Topic
from gz_course.sim.ros.rosbag2.storage.offered_qos import QosProfile


@dataclass
class StorageOptions:
    """The bag to open; sizes in bytes, durations in seconds, 0 is without a limit."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class ConverterOptions:
    """The formats of messages: here always as they are stored."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass
class StorageFilter:
    """The topics to read: by name or by regular expression; empty is all."""

    topics: list[str] = field(default_factory=list)
    services_events: list[str] = field(default_factory=list)
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    regex_to_exclude: str = ""


class ReadOrderSortBy(enum.Enum):
    """By which time messages are sorted."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass
class ReadOrder:
    """The order of reading."""

    sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


@dataclass
class TopicMetadata:
    """A topic of a bag."""

    id: int = 0
    name: str = ""
    type: str = ""
    serialization_format: str = "cdr"
    offered_qos_profiles: list[Any] = field(default_factory=list)
    type_description_hash: str = ""

    def equals(self, other: TopicMetadata) -> bool:
        return self == other

    @classmethod
    def of(cls, number: int, topic: Topic) -> TopicMetadata:
        return cls(number, topic.name, topic.type, topic.serialization_format, list(topic.qos), topic.type_hash)

    def as_topic(self) -> Topic:
        """Return what is written; profiles that were not read from a bag are left out."""
        package, *middle, name = self.type.split("/")
        full = "/".join([package, *(middle or ["msg"]), name])
        profiles = tuple(each for each in self.offered_qos_profiles if isinstance(each, QosProfile))
        return Topic(self.name, full, self.serialization_format or "cdr", profiles, self.type_description_hash)


@dataclass
class TopicInformation:
    """A topic and the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int


@dataclass
class FileInformation:
    """One file of a bag."""

    path: str
    starting_time: Any
    duration: Any
    message_count: int


@dataclass
class MessageDefinition:
    """The definition of a type, as a text."""

    topic_type: str
    encoding: str
    encoded_message_definition: str
    type_hash: str


@dataclass
class BagMetadata:
    """What a bag tells of itself."""

    version: int = 9
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: Any = None
    starting_time: Any = None
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""

    @classmethod
    def of(cls, metadata: Metadata, size: int) -> BagMetadata:
        files = [
            FileInformation(file.path, Time(nanoseconds=file.start), Duration(nanoseconds=file.duration), file.count)
            for file in metadata.files
        ]
        topics = [
            TopicInformation(TopicMetadata.of(number, topic), metadata.counts.get(topic.name, 0))
            for number, topic in enumerate(metadata.topics)
        ]
        return cls(
            metadata.version,
            size,
            metadata.storage,
            [file.path for file in metadata.files],
            files,
            Duration(nanoseconds=metadata.duration),
            Time(nanoseconds=metadata.start),
            metadata.count,
            topics,
            metadata.compression_format,
            metadata.compression_mode,
            metadata.custom_data,
            metadata.distro,
        )


def get_default_storage_id() -> str:
    """Return the storage of a bag if none is given."""
    return "mcap"
