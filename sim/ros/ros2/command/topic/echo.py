"""Output messages from a topic."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import yaml
from rclpy.event_handler import SubscriptionEventCallbacks

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import message_class, message_type_name
from gz_course.sim.ros.ros2.message_text import add_text_options, chosen_text, is_message, to_csv, to_yaml
from gz_course.sim.ros.ros2.option_values import seconds
from gz_course.sim.ros.ros2.qos import add_qos_options, chosen_qos
from gz_course.sim.ros.ros2.topic import (
    following_qos,
    full_name,
    message_filter,
    nearest_topic,
    not_published,
    only_type,
    warn,
)

_FIRST_PUBLISHER = 1.0  # [s] to wait for a publisher whose QoS is adopted, if the type is given


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    parser.add_argument("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    parser.add_argument("--once", action="store_true", help="Print the first message received and then exit")
    parser.add_argument("--timeout", type=seconds, metavar="N", help="Set a timeout in seconds for waiting")
    parser.add_argument("--field", metavar="A.B", help="Echo a selected field of a message")
    parser.add_argument("--filter", metavar="EXPR", help="Python expression on the message m that must be true")
    add_text_options(parser)
    parser.add_argument("--raw", action="store_true", help="Echo the raw binary representation")
    parser.add_argument("--no-lost-messages", action="store_true", help="Don't report when a message is lost")
    parser.add_argument("--lost-messages", action="store_true", help=argparse.SUPPRESS)  # it is the default
    parser.add_argument("-i", "--include-message-info", action="store_true", help="Shows the message info")
    add_qos_options(parser, "what all publishers of the topic offer")


def main(arguments: argparse.Namespace) -> int:
    """Print messages until interrupted, with --once until the first one, with --timeout until it has passed."""
    given = None if arguments.message_type is None else message_class(arguments.message_type)
    passes = message_filter(arguments.filter)
    with Graph(arguments) as graph:
        name = full_name(graph, arguments.topic_name)
        kind = _message_class(graph, name, given)
        printer = _Printer(arguments, kind, passes)
        qos = chosen_qos(arguments, following_qos(graph, name))
        events = None if arguments.no_lost_messages else SubscriptionEventCallbacks(message_lost=_report_lost)
        graph.node.create_subscription(kind, name, printer, qos, raw=arguments.raw, event_callbacks=events)
        end = None if arguments.timeout is None else time.monotonic() + arguments.timeout
        while not (arguments.once and printer.count):
            left = 0.1 if end is None else min(0.1, end - time.monotonic())
            if left <= 0:
                break
            graph.spin_once(left)
    return 0


def _message_class(graph: Graph, name: str, given: Any) -> Any:
    if given is not None:
        graph.wait_for_publisher(name, _FIRST_PUBLISHER)
        types, own = dict(graph.topics(hidden=True)).get(name, []), message_type_name(given)
        if types and own not in types:
            warn(f"The topic {name} has the type {', '.join(types)}, not {own}: no message can arrive")
        return given
    types = graph.wait_for_topic(name)
    if not types:
        not_published(name)
        raise CommandError(f"Could not determine the type for the passed topic{nearest_topic(graph, name)}")
    return only_type(name, types, "echo")


def _report_lost(status: Any) -> None:
    """Say that messages came faster than they were taken; the words are those of ROS 2."""
    print(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}\n\ttotal count: {status.total_count}",
        end="---\n",
    )


class _Printer:
    """Prints messages as the options say; `count` is the number printed so far."""

    def __init__(self, arguments: argparse.Namespace, kind: Any, passes: Callable[[Any], bool] | None) -> None:
        self.count = 0
        self._filter = passes
        self._fields = arguments.field.strip(".").split(".") if arguments.field else []
        self._csv = arguments.csv
        self._with_info = arguments.include_message_info
        self._form = chosen_text(arguments)
        if not arguments.raw:
            self._select(kind())

    def __call__(self, message: Any, info: dict[str, Any]) -> None:
        value = message if isinstance(message, bytes) else self._select(message)
        if self._filter is not None and not self._filter(value):
            return
        self.count += 1
        if self._csv and is_message(value):
            before = "".join(f"{item}," for item in info.values()) if self._with_info else ""
            print(before + to_csv(value, self._form))
        elif is_message(value):
            if self._with_info:
                print(yaml.safe_dump(dict(info)), end="---\n")
            print(to_yaml(value, self._form), end="---\n")
        else:
            if self._with_info:
                print(f"---Got new message, message info:---\n{dict(info)}\n---Message data:---")
            print(value, end="\n---\n")

    def _select(self, message: Any) -> Any:
        """Return the field of `--field`. Raises CommandError with the existing fields if there is no such field."""
        value = message
        for name in self._fields:
            if not is_message(value) or name not in value.get_fields_and_field_types():
                known = list(value.get_fields_and_field_types()) if is_message(value) else []
                has = f"has the fields {', '.join(known)}" if known else "has no fields"
                raise CommandError(
                    f"Invalid field '{'.'.join(self._fields)}': {type(value).__name__} has no field "
                    f"'{name}', it {has}{did_you_mean(name, known)}"
                )
            value = getattr(value, name)
        return value
