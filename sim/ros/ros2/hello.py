"""`ros2 doctor hello`: says hello by a topic and by multicast, and counts who is heard of other machines.

Source: ros2doctor 0.32 (`ros2doctor/verb/hello.py`: topic, texts and table)
"""

from __future__ import annotations

import argparse
import contextlib
import socket
import time
from collections import Counter
from typing import Any

from std_msgs.msg import String

from gz_course.sim.ros.ros2 import multicast
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.topic import full_name

_GREETING = "hello, it's me "
_GRAPH = argparse.Namespace(spin_time=None, use_sim_time=False)


def hello(arguments: argparse.Namespace) -> None:
    """Greet every --emit-period [s] and print a table every --print-period [s], until interrupted or once."""
    own = socket.gethostname()
    heard = Counter[str]()
    caught = Counter[str]()

    def listen(message: Any) -> None:
        _count(message.data, own, heard)

    with Graph(_GRAPH) as graph, multicast.receiver() as packets, contextlib.suppress(KeyboardInterrupt):
        packets.setblocking(False)
        name = full_name(graph, arguments.topic)
        publisher = graph.node.create_publisher(String, name, 10)
        graph.node.create_subscription(String, name, listen, 10)
        sent = 0
        print_at = time.monotonic() + arguments.print_period
        while True:
            publisher.publish(String(data=f"{_GREETING}{own}"))
            multicast.send(f"{_GREETING}{own}".encode(), arguments.ttl)
            sent += 1
            graph.spin_for(arguments.emit_period)
            with contextlib.suppress(BlockingIOError):
                while True:
                    _count(multicast.received(packets)[0], own, caught)
            if time.monotonic() < print_at:
                continue
            _print_table(name, arguments.print_period, sent, heard, caught)
            if arguments.once:
                return
            heard.clear()
            caught.clear()
            sent = 0
            print_at += arguments.print_period


def _count(text: str, own: str, counts: Counter[str]) -> None:
    host = text.split()[-1] if text.split() else ""
    if host not in ("", own):
        counts[host] += 1


def _print_table(topic: str, period: float, sent: int, heard: Counter[str], caught: Counter[str]) -> None:
    print("MULTIMACHINE COMMUNICATION SUMMARY")
    for title, counts in (
        (f"Topic: {topic}, Published Msg Count: {sent}\nSubscribed from:", heard),
        (f"Multicast Group/Port: {multicast.GROUP}/{multicast.PORT}, Sent Msg Count: {sent}\nReceived from:", caught),
    ):
        print(title)
        print(f"{'':<15} {'Hostname':<20} {f'Msg Count /{period}s':<10}")
        for host, count in counts.items():
            print(f"{'':<15} {host:<20} {count:<10}")
    print("-" * 60)
