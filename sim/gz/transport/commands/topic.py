"""Look at topics and publish on them: `gz topic -l`, `gz topic -e -t /odom`.

Output and exit codes are those of the tool of Gazebo Harmonic, with two differences: what is not there is told in one
line on stderr too, and `-p` ends only after the message has been sent, with exit code 1 if nobody could receive it.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/cmd/topic_main.cc
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
import time
from collections.abc import Sequence

from google.protobuf.message import DecodeError, Message

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser, positive_number, whole_number
from gz_course.sim.gz.msgs import canonical_name, message_class
from gz_course.sim.gz.transport.echo_queue import Arrival, EchoQueue
from gz_course.sim.gz.transport.message_info import MessagePublisher
from gz_course.sim.gz.transport.node import Node

_LOOK_FOR_TOPIC_AFTER_S = 1.5
_SUBSCRIBERS_WITHIN_S = 1.5
_SUBSCRIBERS_SETTLE_S = 0.3
_WINDOW = 10
_FORTRESS = "ignition.msgs."
_WAITING = "still waiting for somebody who publishes"


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-t", "--topic", metavar="NAME", help="name of a topic")
    parser.add_argument("-m", "--msgtype", metavar="TYPE", help="type of the message to publish, e.g. gz.msgs.Twist")
    parser.add_argument("-d", "--duration", type=positive_number, metavar="S", help="echo for S seconds, then end")
    parser.add_argument("-n", "--num", type=whole_number, metavar="N", help="echo N messages, then end (0: no end)")
    parser.add_argument("-l", "--list", action="store_true", help="the names of all topics")
    parser.add_argument("-i", "--info", action="store_true", help="publishers and subscribers of a topic")
    parser.add_argument("-e", "--echo", action="store_true", help="print the messages of a topic until Ctrl-C")
    parser.add_argument("-f", "--frequency", action="store_true", help="measure how often messages come, until Ctrl-C")
    parser.add_argument("-p", "--pub", metavar="TEXT", help="publish a message: 'linear: {x: 0.5}, angular: {z: 0.2}'")
    parser.add_argument("--json-output", action="store_true", help="echo each message as one line of JSON")
    parser.commands("--list", "--info", "--echo", "--frequency", "--pub")
    parser.excludes("--duration", "--num")
    for option in ("--info", "--echo", "--frequency"):
        parser.needs(option, "--topic")
    parser.needs("--pub", "--topic", "--msgtype")
    parser.needs("--json-output", "--echo")


def run(values: argparse.Namespace) -> int:
    """Run `gz topic`; return the exit code. Raises ValueError for invalid names, types and texts."""
    with Node() as node:
        if values.topic is not None:
            node.options.qualified(values.topic)
        if values.list:
            for topic in node.topic_list():
                print(topic)
            return 0
        if values.info:
            return _info(node, values.topic)
        if values.echo:
            return _echo(node, values)
        if values.frequency:
            return _frequency(node, values.topic)
        return _publish(node, values)


def _info(node: Node, topic: str) -> int:
    publishers, subscribers = node.topic_info(topic)
    for found, kind in ((publishers, "Publishers"), (subscribers, "Subscribers")):
        if found:
            print(f"{kind} [Address, Message Type]:")
            for each in found:
                print(f"  {each.addr}, {each.msg_type_name}")
        else:
            print(f"No {kind.lower()} on topic [{topic}]")
    if not (publishers or subscribers):
        _report(f"there is no topic [{topic}]{_nearest_topic(node, topic) or '; see gz topic -l'}")
    return 0


def _echo(node: Node, values: argparse.Namespace) -> int:
    end = math.inf if values.duration is None else time.monotonic() + values.duration
    printed = 0
    try:
        with EchoQueue(node, values.topic) as arrivals:
            from gz_course.sim.gz.msgs.text import to_json_line, to_text  # imported during discovery

            look_at = time.monotonic() + _LOOK_FOR_TOPIC_AFTER_S
            while not values.num or printed < values.num:
                arrival = arrivals.next(min(end, look_at))
                if arrival is not None:
                    message = _decoded(arrival, values.topic)
                    if message is None:
                        continue
                    sys.stdout.write(f"{to_json_line(message) if values.json_output else to_text(message)}\n")
                    printed += 1
                elif arrivals.reader_gone() or time.monotonic() >= end:
                    break
                elif time.monotonic() >= look_at:
                    look_at = math.inf
                    _report_unpublished(node, values.topic, printed, _WAITING)
    except KeyboardInterrupt:
        return 0
    if values.duration is not None:
        _report_unpublished(node, values.topic, printed, "nobody published")
    return 0


def _decoded(arrival: Arrival, topic: str) -> Message | None:
    try:
        return message_class(arrival.type_name).FromString(arrival.data)
    except DecodeError:
        _report(f"a message on [{topic}] is no {arrival.type_name}; it is left out.")
        return None


def _frequency(node: Node, topic: str) -> int:
    times: list[int] = []
    try:
        with EchoQueue(node, topic) as arrivals:
            look_at = time.monotonic() + _LOOK_FOR_TOPIC_AFTER_S
            while True:
                arrival = arrivals.next(look_at)
                if arrival is not None and len(times) <= _WINDOW:
                    times.append(arrival.time_ns)
                elif arrival is not None:  # one more than needed, as in Gazebo's tool, which prints on arrival
                    _print_frequency(times)
                    times.clear()
                elif arrivals.reader_gone():
                    return 0
                elif time.monotonic() >= look_at:
                    look_at = math.inf
                    _report_unpublished(node, topic, len(times), _WAITING)
    except KeyboardInterrupt:
        return 0


def _print_frequency(times_ns: Sequence[int]) -> None:
    intervals = [(after - before) * 1e-9 for before, after in itertools.pairwise(times_ns)]
    mean = sum(intervals) / len(intervals)
    deviation = math.sqrt(sum((each - mean) ** 2 for each in intervals) / len(intervals))
    lines = [f"interval [{index}]:    {each:g}s" for index, each in enumerate(intervals)]
    lines.append(f"average rate: {1 / mean if mean else math.inf:g}")
    lines.append(f"min: {min(intervals):g}s max: {max(intervals):g}s std dev: {deviation:g}s window: {len(intervals)}")
    sys.stdout.write("\n\n" + "\n".join(lines) + "\n")


def _publish(node: Node, values: argparse.Namespace) -> int:
    from gz_course.sim.gz.msgs.text import from_text

    message = from_text(values.pub, message_class(values.msgtype))
    spelled = values.msgtype.removeprefix(".")
    type_name = spelled if spelled.startswith(_FORTRESS) else str(message.DESCRIPTOR.full_name)
    publisher = node.advertise(values.topic, type_name)
    count = 0
    if publisher.wait_for_subscribers(1, _SUBSCRIBERS_WITHIN_S):
        count = 1
        while publisher.wait_for_subscribers(count + 1, _SUBSCRIBERS_SETTLE_S):
            count += 1
    publisher.publish_raw(message.SerializeToString(), type_name)
    if count:
        return 0
    listening = [each for each in node.topic_info(values.topic)[1] if _is_other(each, type_name)]
    if listening:
        wanted = listening[0].msg_type_name
        _report(f"the subscribers of [{values.topic}] take {wanted}, so nobody received the {type_name}.")
    else:
        hint = _nearest_topic(node, values.topic) or "; see gz topic -l"
        _report(f"nobody listens on [{values.topic}], so the message is lost{hint}")
    return 1


def _is_other(subscriber: MessagePublisher, type_name: str) -> bool:
    return canonical_name(subscriber.msg_type_name) != canonical_name(type_name)


def _report_unpublished(node: Node, topic: str, heard: int, what: str) -> None:
    if not heard and not node.topic_info(topic)[0]:
        _report(f"{what} on [{topic}]{_nearest_topic(node, topic)}")


def _nearest_topic(node: Node, topic: str) -> str:
    own = {topic, f"/{topic}"}
    return did_you_mean(topic, [each for each in node.topic_list() if each not in own])


def _report(sentence: str) -> None:
    print(f"gz topic: {sentence}", file=sys.stderr)
