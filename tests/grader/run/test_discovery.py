"""What DDS says of the endpoints of others, asked by a node with endpoints of its own."""

import contextlib
import os
import threading
import time

import pytest
import rclpy
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from std_msgs.msg import Float32, String

from gz_course.grader.run.discovery import Discovery
from gz_course.grader.run.domain import Domain

DEADLINE = 60.0  # [s]


@pytest.fixture
def nodes():
    """Make nodes, each in a participant of its own, in a domain of their own."""
    with contextlib.ExitStack() as stack:
        domain = stack.enter_context(Domain())

        def make(name, **options):
            context = Context()
            rclpy.init(args=[], context=context, domain_id=domain.id)
            stack.callback(rclpy.try_shutdown, context=context)
            node = rclpy.create_node(name, context=context, start_parameter_services=False, **options)
            stack.callback(node.destroy_node)
            return node

        yield make


def until(condition):
    deadline = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < deadline
        threading.Event().wait(0.01)


@pytest.fixture
def watching(nodes):
    """The grader's node, which publishes on /odom, and what it sees."""
    node = nodes(f"grader_{os.getpid()}")
    node.create_publisher(String, "/odom", 1)
    discovery = Discovery(node)
    discovery.watch("/odom", String)
    yield discovery
    discovery.close()


def test_its_own_endpoints_are_not_those_of_others(watching):
    assert not watching.publishers_seen("/odom")
    assert list(watching.endpoints()) == [] and watching.nodes() == [] and watching.loggers() == []


@pytest.mark.parametrize("deadline", [None, 1])
def test_a_publisher_that_is_gone_again_was_seen(watching, nodes, deadline):
    other = nodes("other")
    until(lambda: "/other" in watching.nodes() and len(other.get_node_names()) == 2)
    assert not watching.publishers_seen("/odom")
    profile = QoSProfile(depth=1) if deadline is None else QoSProfile(depth=1, deadline=Duration(nanoseconds=deadline))
    other.destroy_publisher(other.create_publisher(String, "/odom", profile))
    until(lambda: watching.publishers_seen("/odom"))


def test_a_publisher_of_another_type_is_seen_while_it_is_there(watching, nodes):
    nodes("other").create_publisher(Float32, "/odom", 1)
    until(lambda: watching.publishers_seen("/odom"))


def test_endpoints_and_loggers_by_the_names_of_their_nodes(watching, nodes):
    nodes("loud", namespace="/some").create_subscription(String, "/words", print, 1)
    nodes("silent", enable_rosout=False)
    until(lambda: [each.node for each in watching.endpoints()] == ["/some/loud"])
    until(lambda: watching.nodes() == ["/silent", "/some/loud"])
    until(lambda: watching.loggers() == ["/some/loud"])
    (endpoint,) = watching.endpoints()
    assert (endpoint.kind, endpoint.topic, endpoint.type) == ("subscription", "/words", "std_msgs/msg/String")
