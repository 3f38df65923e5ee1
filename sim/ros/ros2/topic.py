"""Topic names, types, QoS and message filters for the verbs of `ros2 topic`.

Names without a leading / are in the root namespace.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from rclpy.exceptions import NameValidationException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.qos import DurabilityPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from rclpy.validate_full_topic_name import validate_full_topic_name

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.interface import message_class


def full_name(graph: Graph, name: str, noun: str = "topic") -> str:
    """Return the name of a topic, service or action with its namespace. Raises CommandError for an invalid name."""
    try:
        expanded = expand_topic_name(name, graph.node.get_name(), graph.node.get_namespace())
        validate_full_topic_name(expanded, is_service=noun == "service")
    except (NameValidationException, ValueError) as error:
        reason = str(error).partition(", at ")[0].splitlines()[0]
        article = "an" if noun[0] in "aeiou" else "a"
        raise CommandError(f"'{name}' is not {article} {noun} name: {reason}") from None
    return expanded


def nearest_topic(graph: Graph, name: str) -> str:
    """Return `; did you mean '/x'?` for the nearest topic of the graph, or an empty text."""
    return did_you_mean(name, (topic for topic, _ in graph.topics(hidden=True)))


def not_published(name: str) -> None:
    print(f"WARNING: topic [{name}] does not appear to be published yet")


def only_type(name: str, types: list[str], verb: str) -> Any:
    """Return the message class of a topic with these types. Raises CommandError if there are several."""
    if len(types) > 1:
        raise CommandError(f"Cannot {verb} topic '{name}', as it contains more than one type: [{', '.join(types)}]")
    return message_class(types[0])


def following_qos(graph: Graph, name: str) -> QoSProfile:
    """Return the strictest QoS that all publishers of the topic offer; without a publisher best effort and volatile."""
    qos = QoSPresetProfiles.get_from_short_key("sensor_data")
    offers = [end.qos_profile for end in graph.node.get_publishers_info_by_topic(name)]
    if offers and all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers):
        qos.reliability = ReliabilityPolicy.RELIABLE
    if offers and all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers):
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return qos


def message_filter(expression: str | None) -> Callable[[Any], bool] | None:
    """Return a function of a message `m` for a Python expression such as `m.x > 1`."""
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
    """Print a hint to stderr, so that stdout has only data."""
    print(sentence, file=sys.stderr)
