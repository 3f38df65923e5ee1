"""The data of one bridge: two topic names, two types, a direction and options; and its counters.

`config` (YAML), `arguments` (command line) and `parameters` (ROS parameters) make entries, `bridge.Bridge` runs them.
Nothing here imports ROS, so a configuration can be checked without a node.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable
from dataclasses import dataclass


class Direction(enum.Enum):
    """The direction of a bridge; the values are the words of the YAML file."""

    BIDIRECTIONAL = "BIDIRECTIONAL"
    GZ_TO_ROS = "GZ_TO_ROS"
    ROS_TO_GZ = "ROS_TO_GZ"

    @property
    def to_ros(self) -> bool:
        return self is not Direction.ROS_TO_GZ

    @property
    def to_gz(self) -> bool:
        return self is not Direction.GZ_TO_ROS


@dataclass(frozen=True)
class BridgeEntry:
    """One topic bridged between Gazebo and ROS.

    `publisher_queue` and `subscriber_queue` are depths [messages] on the ROS side; the Gazebo side has no queue. `lazy`
    subscribes on one side only while there is a subscriber on the other. `frame_id` replaces `header.frame_id` of
    messages to ROS. `source` is the place where the entry was written (`bridge.yaml:7`). `qos_profile` is a name of
    `qos_profile.QOS_PROFILES`.
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
        for name in ("publisher_queue", "subscriber_queue"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} must be 1 or more, not {getattr(self, name)}")

    @property
    def place(self) -> str:
        """`source` without the folder of a file, which differs between runs; an argument as it was given."""
        return self.source if "@" in self.source else self.source.rpartition("/")[2]

    @property
    def same_route(self) -> tuple[str, str, str, str]:
        """Both topics and both types; entries for which they are equal carry the same messages."""
        return (self.ros_topic, self.gz_topic, self.ros_type, self.gz_type)


@dataclass(frozen=True)
class ServiceEntry:
    """One Gazebo service offered as a ROS service of the same name.

    An empty Gazebo type means the type that pairs with the ROS type.
    """

    name: str
    ros_type: str
    gz_request_type: str = ""
    gz_reply_type: str = ""
    source: str = ""
    gz_name: str = ""

    @property
    def gz_service(self) -> str:
        """The name on the Gazebo side: `gz_name` if it was expanded, else `name`."""
        return self.gz_name or self.name


@dataclass
class EntryStatus:
    """The counters of one entry [messages].

    `dropped` were refused or could not be converted (`last_error` says why); `skipped` were dropped from a full queue;
    `echoes` are the bridge's own messages coming back, which are ignored.
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
    """Values that a bridge writes into the header of every message to ROS.

    `frame_id` replaces the frame unless the entry has its own; `wall_time` replaces the stamp by the system clock.
    """

    frame_id: str = ""
    wall_time: bool = False


class BridgeError(RuntimeError):
    """Entries that cannot be set up; `errors` holds one sentence for each."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))
