"""What one bridge is: two topic names, two types, a direction and its options; and what became of it.

Entries are made by ``config`` (YAML), ``arguments`` (command line) and ``parameters`` (ROS parameters) and taken by
``bridge.Bridge``. Nothing here imports ROS, so a file can be checked before any node exists.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass


class Direction(enum.Enum):
    """Which way messages travel; the values are the words used in the YAML file."""

    BIDIRECTIONAL = "BIDIRECTIONAL"
    GZ_TO_ROS = "GZ_TO_ROS"
    ROS_TO_GZ = "ROS_TO_GZ"

    @property
    def to_ros(self) -> bool:
        """True when Gazebo messages are to reach ROS."""
        return self is not Direction.ROS_TO_GZ

    @property
    def to_gz(self) -> bool:
        """True when ROS messages are to reach Gazebo."""
        return self is not Direction.GZ_TO_ROS


@dataclass(frozen=True)
class BridgeEntry:
    """One topic bridged between Gazebo and ROS.

    ``publisher_queue`` and ``subscriber_queue`` are depths (messages) on the ROS side; the Gazebo side has no
    queue. ``lazy`` connects the sending side only while somebody listens on the receiving side. ``frame_id``
    replaces ``header.frame_id`` of messages going to ROS. ``source`` says where the entry was written
    (``bridge.yaml:7``), for messages to people. ``qos_profile`` is a name of ``qos_profile.QOS_PROFILES``.
    """

    ros_topic: str
    gz_topic: str
    ros_type: str
    gz_type: str
    direction: Direction = Direction.BIDIRECTIONAL
    publisher_queue: int = 10
    subscriber_queue: int = 10
    lazy: bool = False
    frame_id: str | None = None
    source: str = ""
    qos_profile: str | None = None

    def __post_init__(self) -> None:
        for name, depth in (
            ("publisher_queue", self.publisher_queue),
            ("subscriber_queue", self.subscriber_queue),
        ):
            if depth < 1:
                raise ValueError(f"{name} must be 1 or more, not {depth}")

    @property
    def same_route(self) -> tuple[str, str, str, str]:
        """What makes two entries the same route: both topics and both types."""
        return (self.ros_topic, self.gz_topic, self.ros_type, self.gz_type)


@dataclass(frozen=True)
class ServiceEntry:
    """One Gazebo service offered as a ROS service of the same name; ``gz_request_type`` may be empty, then it is
    the one of the ROS type.
    """

    name: str
    ros_type: str
    gz_request_type: str = ""
    gz_reply_type: str = ""
    source: str = ""
    gz_name: str = ""

    @property
    def gz_service(self) -> str:
        """The name on the Gazebo side: the same, unless it was expanded."""
        return self.gz_name or self.name


@dataclass
class EntryStatus:
    """What went through one entry so far, in messages.

    ``dropped`` were refused or could not be converted (``last_error`` says why); ``skipped`` gave way because they
    came faster than they could be bridged; ``echoes`` are the bridge's own messages coming back, which are ignored.
    """

    entry: BridgeEntry
    ros_to_gz: int = 0
    gz_to_ros: int = 0
    dropped: int = 0
    skipped: int = 0
    echoes: int = 0
    last_error: str | None = None


@dataclass(frozen=True)
class HeaderOverrides:
    """What a bridge writes over the header of every message going to ROS.

    ``frame_id`` replaces the frame unless the entry has one of its own; ``wall_time`` replaces the stamp with
    the system clock.
    """

    frame_id: str = ""
    wall_time: bool = False


class BridgeError(RuntimeError):
    """Entries that cannot be set up; ``errors`` holds one sentence for each."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))
