"""The watch reports once which publishers on Gazebo's side are missing, have ended and have returned."""

import uuid

import pytest

from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.bridge.ros_gz_bridge.watch import MISSING_AFTER_S, Watch
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

SCAN = ("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan")


class Logger(list):
    def warning(self, text):
        self.append(f"warning: {text}")

    def info(self, text):
        self.append(f"info: {text}")


class Bridge:
    """The methods of a bridge that the watch uses."""

    def __init__(self, *entries):
        self.entries = entries

    def say_unsaid(self):
        pass


@pytest.fixture
def nodes():
    options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
    with Node(options) as own, Node(options) as simulator:
        yield own, simulator


def watching(node, *topics, direction=Direction.GZ_TO_ROS):
    log, now = Logger(), [100.0]
    entries = [BridgeEntry(topic, topic, *SCAN, direction) for topic in topics]
    return Watch(Bridge(*entries), node, log, lambda: now[0]), log, now


def test_what_goes_away_and_comes_back_is_said_once(nodes):
    own, simulator = nodes
    watch, log, _ = watching(own, "/scan")
    for _ in range(2):
        publisher = simulator.advertise("/scan", LaserScan)
        watch.look()
        watch.look()
        publisher.close()
        watch.look()
        watch.look()
    assert [line[:60] for line in log] == [
        "warning: nobody in Gazebo publishes /scan any more: the simu",
        "info: Gazebo publishes /scan again",
        "warning: nobody in Gazebo publishes /scan any more: the simu",
    ]


def test_a_topic_that_nobody_publishes_is_said_once_with_the_nearest(nodes):
    own, simulator = nodes
    watch, log, now = watching(own, "/lidar/scna")
    simulator.advertise("/lidar/scan", LaserScan)
    watch.look()
    assert log == []
    now[0] += MISSING_AFTER_S
    watch.look()
    watch.look()
    assert log == ["warning: nobody in Gazebo publishes /lidar/scna so far; did you mean '/lidar/scan'?"]


def test_without_any_simulator_the_partition_is_named(nodes):
    watch, log, now = watching(nodes[0], "/scan")
    now[0] += MISSING_AFTER_S
    watch.look()
    assert log == [
        "warning: nobody in Gazebo publishes /scan so far: no simulator runs in this partition (GZ_PARTITION)"
    ]


def test_another_type_on_the_topic_is_said_once(nodes):
    own, simulator = nodes
    watch, log, _ = watching(own, "/scan")
    simulator.advertise("/scan", Twist)
    watch.look()
    watch.look()
    assert len(log) == 1
    assert "Gazebo publishes gz.msgs.Twist on /scan, but the bridge expects gz.msgs.LaserScan" in log[0]


def test_commands_are_not_waited_for(nodes):
    watch, log, now = watching(nodes[0], "/cmd_vel", direction=Direction.ROS_TO_GZ)
    now[0] += MISSING_AFTER_S
    watch.look()
    assert log == []
