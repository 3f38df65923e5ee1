"""What the verbs of `ros2 topic` that follow one topic have in common: finding it, its type, its QoS, a filter.

Names without a leading / are taken in the root namespace, as ROS does for the command's node.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.qos import DurabilityPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from rclpy.validate_full_topic_name import validate_full_topic_name

from gz_course.sim.ros2.errors import CommandError, did_you_mean
from gz_course.sim.ros2.graph import Graph
from gz_course.sim.ros2.interface import message_class


def full_name(graph: Graph, name: str) -> str:
    """The name with its namespace; CommandError for one ROS does not allow."""
    try:
        expanded = expand_topic_name(name, graph.node.get_name(), graph.node.get_namespace())
        validate_full_topic_name(expanded)
    except (InvalidTopicNameException, ValueError) as error:
        reason = str(error).partition(", at ")[0].splitlines()[0]
        raise CommandError(f"'{name}' is not a topic name: {reason}") from None
    return expanded


def nearest_topic(graph: Graph, name: str) -> str:
    """`; did you mean '/x'?` for the nearest topic of the graph, or nothing."""
    return did_you_mean(name, (topic for topic, _ in graph.topics(hidden=True)))


def not_published(name: str) -> None:
    """Say that nothing is known about a topic."""
    print(f"WARNING: topic [{name}] does not appear to be published yet")


def only_type(name: str, types: list[str], verb: str) -> Any:
    """The message class of a topic whose types are known; CommandError when there are several."""
    if len(types) > 1:
        raise CommandError(f"Cannot {verb} topic '{name}', as it contains more than one type: [{', '.join(types)}]")
    return message_class(types[0])


def following_qos(graph: Graph, name: str) -> QoSProfile:
    """The strictest QoS that all present publishers of the topic offer; best effort and volatile without one."""
    qos = QoSPresetProfiles.get_from_short_key("sensor_data")
    offers = [end.qos_profile for end in graph.node.get_publishers_info_by_topic(name)]
    if offers and all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers):
        qos.reliability = ReliabilityPolicy.RELIABLE
    if offers and all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers):
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return qos


def message_filter(expression: str | None) -> Callable[[Any], bool] | None:
    """A function of the message `m` from a Python expression such as `m.x > 1`."""
    if expression is None:
        return None
    try:
        code = compile(expression, "--filter", "eval")
    except SyntaxError as error:
        raise CommandError(f"--filter '{expression}' is not a Python expression: {error.msg}") from None

    def passes(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))
        except Exception as error:
            raise CommandError(f"--filter '{expression}' failed on a message: {error}") from None

    return passes


def warn(sentence: str) -> None:
    """A hint that must not get between the lines a program reads."""
    print(sentence, file=sys.stderr)
