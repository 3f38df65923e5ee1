"""Observation of the ROS graph of the present domain: nodes, endpoints, bridges, and a few messages of each topic.

It only listens: one hidden node with best-effort subscriptions, which match every publisher and delay none. Images and
point clouds are unsubscribed after one message, so that no lazy camera renders longer than necessary.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterable
from typing import Any

from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from gz_course.grader.tools.diagnose.system import Heard, HeardMessage, RosEndpoint, RosNode, RosSide, RunningBridge
from gz_course.sim.bridge.ros_gz_bridge import bridged_topics
from gz_course.sim.bridge.ros_gz_bridge.config import read_file
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import FIRST_CONTACT, UNKNOWN_NODE, Graph, destroy_ended
from gz_course.sim.ros.ros2.interface import message_class

INTERRUPTED = 130  # exit code
ANSWER_WITHIN = 1.0  # [s] for all nodes to return their parameters
KEEP = 5  # messages kept of a topic
MOST_TOPICS = 200
_CLOCK, _TRANSFORMS = "rosgraph_msgs/msg/Clock", "tf2_msgs/msg/TFMessage"
_HEAVY = {
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage",
    "sensor_msgs/msg/PointCloud2",
    "stereo_msgs/msg/DisparityImage",
    "nav_msgs/msg/OccupancyGrid",
}
_BRIDGE_NAMES = ("ros_gz_bridge", "parameter_bridge", "bridge_node")
UNNAMED = "a node that has not told its name"
NAMES, LOOK_AGAIN = 5.0, 0.05  # [s] for the names of nodes to arrive, and between two looks
_ASKED = ("use_sim_time", bridged_topics.PARAMETER, "config_file")


def observe(seconds: float) -> RosSide:
    """Query the graph, then listen for `seconds` [s]. Raises ros2.errors.CommandError if ROS does not start."""
    options = argparse.Namespace(spin_time=None, use_sim_time=False)
    try:
        with Graph(options, f"_course_diagnose_{os.getpid()}") as graph:
            graph.settle(FIRST_CONTACT)
            side = RosSide(domain=graph.node.context.get_domain_id(), seconds=seconds)
            side.endpoints = _named_endpoints(graph)
            _ask(graph, side)
            _Listener(graph, side).listen(seconds)
            return side
    except KeyboardInterrupt:
        destroy_ended(INTERRUPTED)  # even if DDS blocks
        raise
    finally:
        destroy_ended()


def _named_endpoints(graph: Graph) -> list[RosEndpoint]:
    """Return the endpoints once the name of each one's node is known, or after `NAMES` seconds."""
    deadline = time.monotonic() + NAMES
    while True:
        found = _endpoints(graph)
        if all(end.node != UNNAMED for end in found) or time.monotonic() > deadline:
            return found
        graph.spin_once(LOOK_AGAIN)


def _endpoints(graph: Graph) -> list[RosEndpoint]:
    own = graph.node.get_fully_qualified_name()
    found = []
    for topic, _ in graph.topics(hidden=True):
        for ends, publishes in (
            (graph.node.get_publishers_info_by_topic(topic), True),
            (graph.node.get_subscriptions_info_by_topic(topic), False),
        ):
            for end in ends:
                node = f"{end.node_namespace.rstrip('/')}/{end.node_name}"
                if UNKNOWN_NODE in node:
                    node = UNNAMED
                if node != own:
                    found.append(RosEndpoint(topic, end.topic_type, node, publishes, end.qos_profile))
    return found


# ---- parameters of nodes


def _ask(graph: Graph, side: RosSide) -> None:
    """Ask every node for its parameters, all at once, and find the bridges among the nodes."""
    services = {name for name, _ in graph.services(hidden=True)}
    clients: dict[str, Any] = {}
    waiting: dict[tuple[str, str], Any] = {}
    nodes = graph.nodes(hidden=True)
    for node in dict.fromkeys(nodes):
        service = f"{node}/get_parameters"
        if service in services:
            clients[node] = graph.node.create_client(GetParameters, service)

    def answered() -> bool:
        for node, client in clients.items():
            if (node, _ASKED[0]) not in waiting and client.service_is_ready():
                for name in _ASKED:  # one parameter per call: a node answers nothing if one of several does not exist
                    waiting[node, name] = client.call_async(GetParameters.Request(names=[name]))
        return len(waiting) == len(clients) * len(_ASKED) and all(future.done() for future in waiting.values())

    graph.spin_until(answered, ANSWER_WITHIN)
    told = {key: _value(future.result()) for key, future in waiting.items() if future.done()}
    for client in clients.values():
        graph.node.destroy_client(client)
    for node in nodes:
        answers = any(key[0] == node for key in told) if node in clients else None
        sim_time = told.get((node, "use_sim_time"))
        side.nodes.append(RosNode(node, answers, sim_time if isinstance(sim_time, bool) else None))
    for node in dict.fromkeys(nodes):
        offered, file = told.get((node, bridged_topics.PARAMETER)), told.get((node, "config_file"))
        bridge = _bridge(node, offered, file, [end for end in side.endpoints if end.node == node])
        if bridge is not None:
            side.bridges.append(bridge)


def _value(response: Any) -> Any:
    if response is None or not response.values:
        return None
    value = response.values[0]
    kinds = {
        ParameterType.PARAMETER_BOOL: "bool_value",
        ParameterType.PARAMETER_STRING: "string_value",
        ParameterType.PARAMETER_STRING_ARRAY: "string_array_value",
    }
    return getattr(value, kinds[value.type]) if value.type in kinds else None


def _bridge(node: str, offered: Any, file: Any, ends: list[RosEndpoint]) -> RunningBridge | None:
    """Return the bridge that a node is, or None.

    Its own parameter lists the topics it bridges; for another implementation of ros_gz_bridge its file or its endpoints
    do.
    """
    if isinstance(offered, list | tuple) or hasattr(offered, "tolist"):
        try:
            return RunningBridge(node, tuple(bridged_topics.entries(str(text) for text in offered)))
        except ValueError:
            pass
    if not node.rpartition("/")[2].startswith(_BRIDGE_NAMES):
        return None
    if isinstance(file, str) and file and (entries := read_file(file).tolerant().topics):
        return RunningBridge(node, tuple(entries))
    return RunningBridge(node, tuple(_guessed(ends)), certain=False)


def _guessed(ends: list[RosEndpoint]) -> Iterable[BridgeEntry]:
    """Yield one entry per topic, with the same name on both sides, as command-line arguments define them."""
    for topic in sorted({end.topic for end in ends} - {"/rosout", "/parameter_events"}):
        here = [end for end in ends if end.topic == topic]
        ways = {end.publishes for end in here}
        direction = Direction.BIDIRECTIONAL if len(ways) > 1 else (Direction.ROS_TO_GZ, Direction.GZ_TO_ROS)[ways.pop()]
        yield BridgeEntry(topic, topic, here[0].type, "", direction)


# ---- messages


class _Listener:
    """Collects the first messages of every topic whose messages can be judged."""

    def __init__(self, graph: Graph, side: RosSide) -> None:
        self._graph = graph
        self._side = side
        self._open: dict[str, Any] = {}
        self._done: list[str] = []
        published: dict[str, set[str]] = {}
        for end in side.endpoints:
            if end.publishes:
                published.setdefault(end.topic, set()).add(end.type)
        for topic, types in sorted(published.items())[:MOST_TOPICS]:
            if len(types) == 1:
                self._subscribe(topic, types.pop())

    def _subscribe(self, topic: str, type_name: str) -> None:
        try:
            kind = message_class(type_name)
        except CommandError:  # its package is not installed here
            return
        if type_name not in (_CLOCK, _TRANSFORMS) and "header" not in kind.get_fields_and_field_types():
            return
        durable = topic == "/tf_static"
        qos = QoSProfile(
            depth=100 if type_name in (_CLOCK, _TRANSFORMS) else 5,
            reliability=ReliabilityPolicy.RELIABLE if durable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
        )
        heard = self._side.heard[topic] = Heard(topic, type_name)
        self._open[topic] = self._graph.node.create_subscription(
            kind, topic, lambda message: self._hear(heard, message), qos
        )

    def _hear(self, heard: Heard, message: Any) -> None:
        heard.count += 1
        now = time.monotonic()
        if heard.type == _CLOCK:
            if heard.topic == "/clock":
                self._side.clock.append((now, message.clock.sec * 10**9 + message.clock.nanosec))
            return
        if heard.type == _TRANSFORMS:
            for transform in message.transforms:
                self._side.frames |= {transform.header.frame_id.strip("/"), transform.child_frame_id.strip("/")}
        clock_ns = self._side.clock[-1][1] if self._side.clock else None
        if len(heard.messages) < KEEP:
            heard.messages.append(HeardMessage(now, clock_ns, message))
        if heard.type != _TRANSFORMS and len(heard.messages) >= (1 if heard.type in _HEAVY else KEEP):
            heard.full = True
            self._done.append(heard.topic)

    def listen(self, seconds: float) -> None:
        """Spin for `seconds` [s], and unsubscribe from each topic with enough messages."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self._graph.spin_once(min(0.1, left))
            while self._done:
                if (subscription := self._open.pop(self._done.pop(), None)) is not None:
                    self._graph.node.destroy_subscription(subscription)
