"""A stage for tests of a running bridge: a node on either side for the bridge, and one for the test."""

import uuid

import pytest

from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

TWIST = ("geometry_msgs/msg/Twist", "gz.msgs.Twist")
SCAN = ("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan")
with_and_without_threads = pytest.mark.parametrize("threaded", [False, True], ids=["one thread", "threads"])


class Stage:
    """A node for the bridge and one for the test, on both sides, with their own topics."""

    def __init__(self, ros, eventually):
        self.topic = f"/t{uuid.uuid4().hex}"
        self.ros = ros
        self.node = ros.new_node()
        options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
        self.gz_bridge, self.gz = Node(options), Node(options)
        self._eventually = eventually
        self._ours = []
        self._bridges = []

    def bridge(self, *entries, **options):
        bridge = Bridge(self.node, self.gz_bridge, entries, **options)
        self._bridges.append(bridge)
        return bridge

    def entry(self, types=TWIST, direction=Direction.BIDIRECTIONAL, **options):
        return BridgeEntry(self.topic, self.topic, *types, direction, **options)

    def ros_publisher(self, ros_class, listeners=1):
        publisher = self.ros.node.create_publisher(ros_class, self.topic, 10)
        self._ours.append(lambda: self.ros.node.destroy_publisher(publisher))
        self._eventually(
            lambda: publisher.get_subscription_count() >= listeners and self._bridge_knows_all(),
            "the bridge listens to ROS",
        )
        return publisher

    def ros_subscription(self, ros_class, callback, qos=10):
        subscription = self.ros.node.create_subscription(ros_class, self.topic, callback, qos)
        self._ours.append(lambda: self.ros.node.destroy_subscription(subscription))
        self._eventually(
            lambda: subscription.get_publisher_count() >= 1 and self._bridge_knows_all(), "the bridge publishes to ROS"
        )
        return subscription

    def _bridge_knows_all(self):
        """Whether the endpoints of the bridge are matched, too: one side may know before the other."""
        publishers = self.ros.node.count_publishers(self.topic)
        subscribers = self.ros.node.count_subscribers(self.topic)
        ends = [each.get_publisher_count() >= publishers for each in self._of_topic(self.node.subscriptions)]
        ends += [each.get_subscription_count() >= subscribers for each in self._of_topic(self.node.publishers)]
        return all(ends)

    def _of_topic(self, endpoints):
        return [each for each in endpoints if each.topic_name == self.topic]

    def close(self):
        for bridge in self._bridges:
            bridge.close()
        for destroy in self._ours:
            destroy()
        self.ros.drop_node(self.node)
        self.gz.close()
        self.gz_bridge.close()
