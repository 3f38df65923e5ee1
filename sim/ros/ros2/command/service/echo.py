"""Echo a service."""

from __future__ import annotations

import argparse
from typing import Any

from rclpy.qos import QoSPresetProfiles
from service_msgs.msg import ServiceEventInfo

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import service_class, service_type_name
from gz_course.sim.ros.ros2.message_text import add_text_options, chosen_text, plain_to_yaml, to_csv, to_plain
from gz_course.sim.ros.ros2.qos import add_qos_options, chosen_qos
from gz_course.sim.ros.ros2.service import nearest_service, service_name, service_types
from gz_course.sim.ros.ros2.topic import warn

_EVENTS = {
    getattr(ServiceEventInfo, name): name
    for name in ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("service_name", help="Name of the ROS service to echo (e.g. '/add_two_ints')")
    parser.add_argument("service_type", nargs="?", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')")
    add_text_options(parser)
    add_qos_options(parser, "services_default")


def main(arguments: argparse.Namespace) -> None:
    """Print the events of a service and its clients until interrupted: those that have introspection configured."""
    given = None if arguments.service_type is None else service_class(arguments.service_type)
    form = chosen_text(arguments)

    def show(event: Any) -> None:
        if arguments.csv:
            print(to_csv(event, form))
            return
        fields = to_plain(event, form)
        number = fields["info"]["event_type"]
        fields["info"]["event_type"] = _EVENTS.get(number, number)
        print(plain_to_yaml(fields, form), end="---\n")

    with Graph(arguments) as graph:
        name = service_name(graph, arguments.service_name)
        kind = given or _type_of(graph, name)
        topic = f"{name}/_service_event"
        qos = chosen_qos(arguments, QoSPresetProfiles.get_from_short_key("services_default"))
        graph.node.create_subscription(kind.Event, topic, show, qos)
        if not graph.wait_for(lambda: graph.node.count_publishers(topic)):
            warn(
                f"Nobody publishes events of {name} yet; its server or a client must call "
                "configure_introspection(clock, qos_profile, ServiceIntrospectionState.CONTENTS)"
                f"{nearest_service(graph, name)}"
            )
        else:
            _warn_of_other_type(graph, name, topic, kind)
        graph.spin_until(lambda: False)


def _type_of(graph: Graph, name: str) -> Any:
    types = service_types(graph, name)
    if len(types) > 1:
        raise CommandError(f"Cannot echo service '{name}', as it contains more than one type: [{', '.join(types)}]")
    if not types:
        raise CommandError(f"Could not determine the type for the passed service{nearest_service(graph, name)}")
    return service_class(types[0])


def _warn_of_other_type(graph: Graph, name: str, topic: str, kind: Any) -> None:
    own = f"{service_type_name(kind)}_Event"
    types = {end.topic_type for end in graph.node.get_publishers_info_by_topic(topic)}
    if types and own not in types:
        warn(f"The events of {name} have the type {', '.join(sorted(types))}, not {own}: none can arrive")
