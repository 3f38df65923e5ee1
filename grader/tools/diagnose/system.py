"""The observation of a live system: both graphs, the bridges between them, and the messages of a short time.

`ros_side` and `gz_side` fill it, the files in `looks/` read it. Names are full names. The endpoints of bridges are kept
apart from those of others, because a bridge connects topics and does not use them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from gz_course.grader.tools.diagnose.world_text import WorldText
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry
from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.gz.transport import MessagePublisher, ServicePublisher
from gz_course.sim.ros.ros_program.last_words import LastWords

OTHER_TYPE = 0.8
"""Least similarity of a name that may be the intended one although its type differs."""

INFRASTRUCTURE = frozenset({"/rosout", "/parameter_events", "/clock", "/tf", "/tf_static", "/robot_description"})
"""ROS topics of many nodes that may be unused."""


@dataclass(frozen=True)
class RosEndpoint:
    """One publisher or subscription of a ROS node; `qos` is an rclpy QoSProfile."""

    topic: str
    type: str
    node: str
    publishes: bool
    qos: Any


@dataclass(frozen=True)
class RosNode:
    """A node and its parameters: `answers` is None if it has no parameter services."""

    name: str
    answers: bool | None
    use_sim_time: bool | None = None


@dataclass(frozen=True)
class HeardMessage:
    """A message, its arrival [s] (monotonic clock), and the latest ROS clock known then [ns]."""

    arrival: float
    clock_ns: int | None
    message: Any


@dataclass
class Heard:
    """The number of messages on one ROS topic, and the first few. `full`: there may have been more."""

    topic: str
    type: str
    count: int = 0
    full: bool = False
    messages: list[HeardMessage] = field(default_factory=list)


@dataclass(frozen=True)
class RunningBridge:
    """A running bridge. `certain` is False if its entries were guessed from its endpoints."""

    node: str
    entries: tuple[BridgeEntry, ...]
    certain: bool = True


@dataclass
class RosSide:
    """The ROS graph of one domain. `clock` holds (monotonic arrival [s], time [ns]) of each `/clock` message."""

    domain: int = 0
    nodes: list[RosNode] = field(default_factory=list)
    endpoints: list[RosEndpoint] = field(default_factory=list)
    bridges: list[RunningBridge] = field(default_factory=list)
    heard: dict[str, Heard] = field(default_factory=dict)
    clock: list[tuple[float, int]] = field(default_factory=list)
    frames: set[str] = field(default_factory=set)
    """Frames on /tf and /tf_static."""
    seconds: float = 0.0
    """Duration of the observation [s]."""


@dataclass
class Drive:
    """A drive system of a model: its commands and its motion while it was observed.

    `commands` are arrivals [s] of the monotonic clock, `speeds` (arrival [s], [m/s], [rad/s]) from its odometry.
    """

    model: str
    system: str
    command_topic: str
    odometry_topic: str
    commands: list[float] = field(default_factory=list)
    speeds: list[tuple[float, float, float]] = field(default_factory=list)


@dataclass
class GzWorld:
    """A world in the partition: its servers, its statistics (gz.msgs.WorldStatistics), its SDF if it answered."""

    name: str
    servers: set[tuple[str, str]] = field(default_factory=set)
    """(process, node) of every server of this name."""
    statistics: list[Any] = field(default_factory=list)
    text: WorldText | None = None
    drives: list[Drive] = field(default_factory=list)


@dataclass
class GzSide:
    """The Gazebo graph of one partition, and the worlds in other ones (partition -> names)."""

    partition: str = ""
    publishers: list[MessagePublisher] = field(default_factory=list)
    subscribers: list[MessagePublisher] = field(default_factory=list)
    services: list[ServicePublisher] = field(default_factory=list)
    worlds: list[GzWorld] = field(default_factory=list)
    elsewhere: dict[str, set[str]] = field(default_factory=dict)
    seconds: float = 0.0


@dataclass(frozen=True)
class StoppedProcess:
    """A process that was stopped by a signal, with its command line."""

    pid: int
    command: str


@dataclass(frozen=True)
class DistantProcess:
    """A process of this user in the same Gazebo partition and another ROS domain, with its command line."""

    pid: int
    command: str
    domain: int


@dataclass
class System:
    """Both sides at one moment, and the processes that belong to them: stopped, in another domain, or ended."""

    ros: RosSide
    gz: GzSide
    stopped: list[StoppedProcess] = field(default_factory=list)
    distant: list[DistantProcess] = field(default_factory=list)
    ended: list[LastWords] = field(default_factory=list)
    """Programs that ended at their start and were not started again since."""

    def __post_init__(self) -> None:
        self._bridge_nodes = {bridge.node for bridge in self.ros.bridges}
        self._gz_bridge_nodes = {node for bridge in self.ros.bridges for node in self._gz_nodes_of(bridge)}

    def entries(self) -> list[tuple[RunningBridge, BridgeEntry]]:
        """Return every entry of every bridge, with its bridge."""
        return [(bridge, entry) for bridge in self.ros.bridges for entry in bridge.entries]

    def is_bridge(self, node: str) -> bool:
        return node in self._bridge_nodes

    def ros_ends(self, topic: str, *, publish: bool) -> list[RosEndpoint]:
        """Return the publishers (or subscriptions) of a ROS topic, including those of bridges."""
        return [end for end in self.ros.endpoints if end.topic == topic and end.publishes == publish]

    def ros_users(self, topic: str, *, publish: bool) -> list[RosEndpoint]:
        """Return the publishers (or subscriptions) of a ROS topic, except those of bridges."""
        return [end for end in self.ros_ends(topic, publish=publish) if not self.is_bridge(end.node)]

    def gz_users(self, topic: str, *, publish: bool) -> list[MessagePublisher]:
        """Return the publishers (or subscribers) of a Gazebo topic, except those of bridges."""
        ends = self.gz.publishers if publish else self.gz.subscribers
        return [end for end in ends if end.topic == topic and end.n_uuid not in self._gz_bridge_nodes]

    def gz_topics(self, *, publish: bool) -> dict[str, set[str]]:
        """Return the types of each Gazebo topic that others than bridges publish (or subscribe to), by topic."""
        found: dict[str, set[str]] = {}
        for end in self.gz.publishers if publish else self.gz.subscribers:
            if end.n_uuid not in self._gz_bridge_nodes:
                found.setdefault(end.topic, set()).add(end.msg_type_name)
        return found

    def _gz_nodes_of(self, bridge: RunningBridge) -> set[str]:
        """Return the Gazebo nodes with exactly the endpoints of a bridge, as Gazebo's graph has no names of nodes."""
        sends = {entry.gz_topic for entry in bridge.entries if entry.direction.to_gz}
        takes = {entry.gz_topic for entry in bridge.entries if entry.direction.to_ros}
        always = {entry.gz_topic for entry in bridge.entries if entry.direction.to_ros and not entry.lazy}
        published: dict[str, set[str]] = {}
        subscribed: dict[str, set[str]] = {}
        for ends, table in ((self.gz.publishers, published), (self.gz.subscribers, subscribed)):
            for end in ends:
                table.setdefault(end.n_uuid, set()).add(end.topic)
        return {
            node
            for node in {*published, *subscribed}
            if published.get(node, set()) == sends and always <= subscribed.get(node, set()) <= takes
        }


def names(words: Iterable[str]) -> str:
    """Return `a`, `a and b` or `a, b and c`, sorted and without repetitions."""
    each = sorted(set(words))
    return each[0] if len(each) == 1 else f"{', '.join(each[:-1])} and {each[-1]}" if each else "nobody"


def users(ends: Iterable[RosEndpoint], verb: str) -> str:
    """Return the nodes of endpoints and a verb, given in the plural: `/a publishes`, `/a and /b publish`."""
    nodes = {end.node for end in ends}
    singular = f"{verb}es" if verb.endswith("sh") else f"{verb}s"
    return f"{names(nodes)} {verb if len(nodes) > 1 else singular}"


def nearest_topic(name: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the known topic that was probably meant, by its ending or its spelling; empty if there is none.

    `cutoff` is the least similarity, from 0 to 1; it should be greater if the types differ.
    """
    others = sorted(set(known) - {name})
    tail = name.rpartition("/")[2]
    alike = [other for other in others if other.rpartition("/")[2] == tail] or others
    return nearest_name(name, alike, cutoff=0.0 if alike is not others else cutoff)
