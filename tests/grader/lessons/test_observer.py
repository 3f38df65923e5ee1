"""Looks at the ROS graph: how long they wait, and what they find."""

import sys

import pytest

from gz_course.grader.lessons.observer import FOUND, SEEN, until_found
from gz_course.grader.lessons.running_world import RunningWorld
from gz_course.grader.lessons.step import NotYet
from gz_course.grader.tools.playground import Playground

RELAY = """
import sys
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("relay")
publisher = node.create_publisher(String, "/word", 10)
if "both" in sys.argv:
    node.create_subscription(String, "/word", print, 10)
node.create_timer(0.1, lambda: publisher.publish(String(data="yes")))
rclpy.spin(node)
"""

LAZY = """
- ros_topic_name: /front/scan
  gz_topic_name: /lidar/scan
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  lazy: true
"""


class Graph:
    """A graph in which `names` are found at their times [s]; waiting costs its own time."""

    def __init__(self, names):
        self._names, self.now = names, 0.0

    def get_node_names(self):
        return ["step", *(name for name, at in self._names.items() if at <= self.now)]

    def spin_until(self, holds, deadline):
        end = self.now + deadline
        while not holds() and self.now < end:
            self.now += 0.5


@pytest.mark.parametrize(
    ("names", "waited"),
    [
        ({"talker": 15.0}, 15.0),
        ({"other": 1.0, "talker": 7.0}, 7.0),
        ({"other": 1.0}, 1.0 + SEEN),
        ({"_daemon": 0.0, "talker": 15.0}, 15.0),
        ({}, FOUND + SEEN),
    ],
)
def test_a_look_ends_with_its_fact_and_is_long_only_without_it(names, waited):
    graph = Graph(names)
    until_found(graph, graph.spin_until, lambda: "talker" in graph.get_node_names())
    assert graph.now == waited


@pytest.fixture
def world(tmp_path):
    (tmp_path / "relay.py").write_text(RELAY)
    with Playground() as room:
        world = RunningWorld(room, ("try", "", ""), {}, tmp_path)
        world.relay = lambda *words: room.start(f"{sys.executable} {tmp_path / 'relay.py'} {' '.join(words)}")
        yield world


def test_a_node_that_publishes_is_found_and_heard(world):
    world.relay()
    assert world.publishers("/word") == ["relay"]
    assert world.topics("/word") == {"/word": ["std_msgs/msg/String"]}
    assert [each.data for each in world.heard("/word", "std_msgs/msg/String", 3)] == ["yes"] * 3
    assert world.both_ways("/word") == []
    assert world.subscribers("/word") == []
    assert not world.silent("/word", "std_msgs/msg/String", 1.0)
    with pytest.raises(NotYet, match="On /words no message came"):
        world.heard("/words", "std_msgs/msg/String")


def test_a_node_that_publishes_what_it_hears_goes_both_ways(world):
    world.relay("both")
    assert world.both_ways("/word", "std_msgs/msg/String") == ["relay"]
    assert world.both_ways("/word") == ["relay"]
    assert world.subscribers("/word") == ["relay"]


def test_a_lazy_bridge_in_both_directions_is_found_while_somebody_listens(world, tmp_path):
    (tmp_path / "lazy.yaml").write_text(LAZY)
    world.start("gz sim lidar_room.sdf -r -s", "")
    world.start(f"ros2 run ros_gz_bridge parameter_bridge --ros-args -p config_file:={tmp_path}/lazy.yaml", "ready")
    assert world.both_ways("/front/scan", "sensor_msgs/msg/LaserScan") == ["ros_gz_bridge"]
