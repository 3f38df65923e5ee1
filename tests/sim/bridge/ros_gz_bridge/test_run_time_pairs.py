"""A message of every pair whose ROS class is made at run time goes through the bridge to Gazebo and back, over DDS."""

import uuid

import pytest

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.sim.ros.rosidl.packages import packages
from gz_course.tests.sim.bridge.ros_gz_bridge.ros_messages import plain

PAIRS = [pair for pair in type_pairs.pairs() if pair.ros_type.split("/")[0] in packages()]


def sample(pair):
    """Return a message that is not blank where the class has a name, a header or a list of its own kind."""
    ros = pair.to_ros(pair.to_gz(pair.ros_class()))
    if hasattr(ros, "header"):
        ros.header.frame_id, ros.header.stamp.sec = "robot/base", 7
    for name, kind in ros.get_fields_and_field_types().items():
        if kind == "string":
            setattr(ros, name, "a name")
        elif kind in ("sequence<float>", "sequence<double>"):
            setattr(ros, name, [1.5, -2.0])
    return ros


@pytest.fixture
def gazebos():
    """Return a Gazebo node for each direction: a bridge does not carry back what it has sent itself."""
    options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
    with Node(options) as there, Node(options) as back:
        yield there, back


def test_every_pair_crosses_twice(ros, gazebos, inbox, eventually):
    assert len(PAIRS) == 26
    stem, node = f"/t{uuid.uuid4().hex}", ros.new_node()
    there, back, ends = [], [], []
    for number, pair in enumerate(PAIRS):
        names = [f"{stem}/n{number}/{place}" for place in ("sent", "gz", "got")]
        types = (pair.ros_type, pair.gz_type)
        there.append(BridgeEntry(names[0], names[1], *types, Direction.ROS_TO_GZ))
        back.append(BridgeEntry(names[2], names[1], *types, Direction.GZ_TO_ROS))
        got = inbox()
        publisher = ros.node.create_publisher(pair.ros_class, names[0], 10)
        ends.append((pair, publisher, ros.node.create_subscription(pair.ros_class, names[2], got, 10), got))
    with Bridge(node, gazebos[0], there), Bridge(node, gazebos[1], back):
        for pair, publisher, subscription, got in ends:
            eventually(publisher.get_subscription_count, f"the bridge listens to {pair.ros_type}")
            eventually(subscription.get_publisher_count, f"the bridge publishes {pair.ros_type}")
            publisher.publish(sample(pair))
            (message,) = got.wait(1)
            assert type(message) is pair.ros_class
            assert plain(message) == plain(pair.to_ros(pair.to_gz(sample(pair)))), pair.ros_type
    for _, publisher, subscription, _ in ends:
        ros.node.destroy_publisher(publisher)
        ros.node.destroy_subscription(subscription)
    ros.drop_node(node)
