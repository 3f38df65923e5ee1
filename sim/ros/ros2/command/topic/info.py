"""Print information about a topic."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.topic import nearest_topic


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to get info (e.g. '/chatter')")
    parser.add_argument(
        "-v",
        "--verbose",
        action="store_true",
        help="Also print node names, namespaces, topic types, topic type hashes, GIDs and QoS profiles",
    )


def main(arguments: argparse.Namespace) -> None:
    name = arguments.topic_name
    with Graph(arguments) as graph:
        if graph.wait_for_topic(name):
            graph.settle()
        types = dict(graph.topics(hidden=True)).get(name)
        if types is None:
            raise CommandError(f"Unknown topic '{name}'{nearest_topic(graph, name)}")
        end = "\n\n" if arguments.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        for noun, count, endpoints in (
            ("Publisher", graph.node.count_publishers, graph.node.get_publishers_info_by_topic),
            ("Subscription", graph.node.count_subscribers, graph.node.get_subscriptions_info_by_topic),
        ):
            print(f"{noun} count: {count(name)}", end=end)
            for endpoint in endpoints(name) if arguments.verbose else ():
                print(endpoint, end=end)
