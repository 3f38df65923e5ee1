"""Publish a message to a topic."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from typing import Any

from rclpy.exceptions import InvalidNodeNameException
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.validate_node_name import validate_node_name

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import message_class, message_type_name
from gz_course.sim.ros.ros2.message_value import fill
from gz_course.sim.ros.ros2.option_values import positive_number, rate, seconds, whole_number
from gz_course.sim.ros.ros2.qos import add_qos_options, chosen_qos
from gz_course.sim.ros.ros2.topic import full_name, warn

_SAY_AGAIN = 1.0  # [s] between two lines while there is no subscription
_HINT_AFTER = 2  # number of such lines before the nearest topic is named


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')")
    parser.add_argument("message_type", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    parser.add_argument(
        "values",
        nargs="?",
        default="{}",
        help="Values to fill the message with in YAML format (e.g. 'data: Hello World'), otherwise default values. "
        "'header: auto' and 'stamp: now' are set to the time of sending",
    )
    parser.add_argument("--stdin", action="store_true", help="Read the values from standard input")
    parser.add_argument("-r", "--rate", type=rate, default=1.0, metavar="N", help="Publishing rate in Hz (default: 1)")
    parser.add_argument(
        "-p",
        "--print",
        dest="print_every",
        type=whole_number,
        default=1,
        metavar="N",
        help="Only print every N-th published message; 0: none (default: 1)",
    )
    times = parser.add_mutually_exclusive_group()
    times.add_argument("-1", "--once", action="store_true", help="Publish one message and exit")
    times.add_argument(
        "-t", "--times", type=positive_number, metavar="N", help="Publish this number of times and then exit"
    )
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        type=whole_number,
        metavar="N",
        help="Wait until so many matching subscriptions are found (default: 1 with --once or --times, else 0)",
    )
    parser.add_argument(
        "--max-wait-time-secs", type=seconds, metavar="SECONDS", help="How long to wait for them (default: for ever)"
    )
    parser.add_argument(
        "--keep-alive",
        type=seconds,
        default=0.1,
        metavar="SECONDS",
        help="Stay so long after the last message (default: 0.1)",
    )
    parser.add_argument("-n", "--node-name", help="Name of the created publishing node")
    add_qos_options(parser, "reliable and transient local, which every subscription can receive")


def main(arguments: argparse.Namespace) -> None:
    """Publish until interrupted or the requested number of times; message and subscriptions are checked first."""
    kind = message_class(arguments.message_type)
    message = kind()
    stamps = fill(message, sys.stdin.read() if arguments.stdin else arguments.values)
    _check_node_name(arguments.node_name)
    times = 1 if arguments.once else arguments.times
    wanted = arguments.wait_matching_subscriptions
    if wanted is None:
        wanted = 0 if times is None else 1
    with Graph(arguments, arguments.node_name) as graph:
        name = full_name(graph, arguments.topic_name)
        publisher = graph.node.create_publisher(kind, name, chosen_qos(arguments, _reaches_everybody()))
        graph.settle()  # so that existing subscriptions receive the first message, too
        _wait_for_subscriptions(graph, publisher, wanted, arguments.max_wait_time_secs)
        print("publisher: beginning loop")
        for count in _ticks(graph, 1.0 / arguments.rate, times):
            now = graph.node.get_clock().now().to_msg()
            for stamp in stamps:
                stamp(now)
            if arguments.print_every and count % arguments.print_every == 0:
                print(f"publishing #{count}: {message!r}\n")
            publisher.publish(message)
        graph.spin_for(arguments.keep_alive)


def _check_node_name(name: str | None) -> None:
    if name is not None:
        try:
            validate_node_name(name)
        except InvalidNodeNameException as error:
            raise CommandError(f"'{name}' is not a node name: {str(error).splitlines()[0]}") from None


def _reaches_everybody() -> QoSProfile:
    return QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def _ticks(graph: Graph, period: float, times: int | None) -> Iterator[int]:
    """Yield 1, 2, 3, ... every `period` [s], the first at once; `times` numbers, or without end."""
    start = time.monotonic()
    count = 0
    while times is None or count < times:
        graph.spin_for(start + count * period - time.monotonic())
        count += 1
        yield count


def _wait_for_subscriptions(graph: Graph, publisher: Any, wanted: int, timeout: float | None) -> None:
    """Wait for `wanted` matching subscriptions; report once per second that they are missing, and why."""
    started = time.monotonic()
    lines = 0
    while not graph.spin_until(lambda: publisher.get_subscription_count() >= wanted, _until_next(started, timeout)):
        found = publisher.get_subscription_count()
        if timeout is not None and time.monotonic() - started >= timeout:
            raise CommandError(
                f"Timed out waiting for subscribers: Expected {wanted} subscribers but only got {found} subscribers"
                + _why_nobody_listens(graph, publisher)
            )
        print(f"Waiting for at least {wanted} matching subscription(s)...")
        lines += 1
        if lines == _HINT_AFTER and (why := _why_nobody_listens(graph, publisher)):
            warn(f"{publisher.topic_name} has {found} matching subscription(s){why}")


def _until_next(started: float, timeout: float | None) -> float:
    left = _SAY_AGAIN if timeout is None else started + timeout - time.monotonic()
    return max(0.0, min(_SAY_AGAIN, left))


def _why_nobody_listens(graph: Graph, publisher: Any) -> str:
    """Return the types or the QoS of subscriptions that do not match, or the nearest topic with a subscription."""
    name, own = publisher.topic_name, message_type_name(publisher.msg_type)
    ends = graph.node.get_subscriptions_info_by_topic(name)
    others = sorted({end.topic_type for end in ends} - {own})
    if others:
        return f"; its subscribers want {', '.join(others)}, not {own}"
    if ends:
        wants = ", ".join(sorted({end.qos_profile.reliability.short_key for end in ends}))
        return f"; its subscribers ask for another quality of service ({wants})"
    listened = (topic for topic, _ in graph.topics() if topic != name and graph.node.count_subscribers(topic))
    return did_you_mean(name, listened)
