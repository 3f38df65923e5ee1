"""The grader's own end of the ROS graph."""

import gc

import pytest
import rclpy.executors
from rclpy.qos import DurabilityPolicy

from gz_course.grader.run.domain import Domain
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, BridgeError, Direction
from gz_course.sim.gz.transport import Node, NodeOptions, Scope


def executors():
    return {each for each in gc.get_objects() if isinstance(each, rclpy.executors.Executor) and not each._is_shutdown}


def test_nothing_stays_open_if_a_bridge_cannot_be_made():
    before = executors()
    wrong = BridgeEntry("/x", "/x", "std_msgs/msg/Flot32", "gz.msgs.Float", Direction.GZ_TO_ROS)
    with Node(NodeOptions(scope=Scope.PROCESS)) as node, Domain() as domain:
        with pytest.raises(BridgeError, match="std_msgs/msg/Float32") as told:
            GraderEndpoints(domain.id, node, [wrong], {}, print)
        assert executors() <= before
    assert told.value  # and with it all that was alive when it was raised


def test_static_transforms_are_taken_that_were_published_before():
    observe = {"/tf_static": "tf2_msgs/msg/TFMessage", "/wall": "sensor_msgs/msg/Range"}
    with Node(NodeOptions(scope=Scope.PROCESS)) as node, Domain() as domain:
        endpoints = GraderEndpoints(domain.id, node, [], observe, print)
        try:
            asked = {s.topic_name: s.qos_profile.durability for s in endpoints._node.subscriptions}
        finally:
            endpoints.close()
    assert asked["/tf_static"] is DurabilityPolicy.TRANSIENT_LOCAL
    assert asked["/wall"] is DurabilityPolicy.VOLATILE
