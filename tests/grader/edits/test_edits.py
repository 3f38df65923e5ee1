"""Edits: one place changed, the rest of the file as it was, and still a file of its type."""

import ast
import warnings
from pathlib import Path

import pytest
import yaml

from gz_course.grader.edits import Vocabulary, edits_of
from gz_course.grader.edits.edit import both

ROOT = Path(__file__).parents[3]
KNOWN = Vocabulary(
    numbers=(0.16, 3),
    ratios=(0.02,),
    topics=("/cmd_vel", "/lidar/scan"),
    types=("std_msgs/msg/Float32", "gz.msgs.LaserScan"),
    texts=("hello, robot",),
)
NODE = """\
import rclpy
from std_msgs.msg import Float64


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_val", 10)
        listener = TransformListener(self.buffer, self)

    def on_scan(self, scan):
        valid = [r for r in scan.ranges]
        stamp = self.get_clock().now().to_msg()
        if now - start < LIMIT:
            command.angular.z = 5.7
            command.linear.x = speed / scan.ranges[0]
        else:
            self.timer.cancel()
        self.publisher.publish(command)

    def answer(self, request, response):
        response.success = True

    def drive(self, goal_handle):
        return Result()


def main():
    Teleop()
"""
BRIDGE = """\
- ros_topic_name: /scan
  ros_type_name: gz.msgs.LaserScan
  gz_type_name: sensor_msgs/msg/LaserScan
  direction: ROS_TO_GZ
"""
XACRO = """\
<robot><!-- 7 --><link name="base"/><wheel_separation>${gap / 2}</wheel_separation>
  <mass value="-4"/><remap to="/cmd_val"/></robot>
"""


def changes(text, file="node.py", known=KNOWN):
    return {f"{edit.line}: {edit.was} -> {edit.now}": edit.operator for edit in edits_of(file, text.encode(), known)}


@pytest.mark.parametrize(
    ("change", "operator"),
    [
        ("""8: "/cmd_val" -> '/cmd_vel'""", "name"),
        ("15: 5.7 -> -5.7", "number"),
        ("15: 5.7 -> 0.114", "number"),
        ("15: 5.7 -> 0.16", "number"),
        ("15: 5.7 -> 0.0994838", "number"),
        ("15: command.angular.z -> command.angular.x", "field"),
        ("14: now - start < LIMIT -> now - start > LIMIT", "comparison"),
        ("14: now - start < LIMIT -> not (now - start < LIMIT)", "condition"),
        ("14: now - start -> (start - now)", "sign"),
        ("16: speed / scan.ranges[0] -> (speed)", "arithmetic"),
        ("16: 0 -> -1", "index"),
        ("12: scan.ranges -> scan.ranges if scan.range_min <= r <= scan.range_max", "filter"),
        ("13: self.get_clock().now().to_msg() -> scan.header.stamp", "clock"),
        ("22: True -> False", "switch"),
        ("29: Teleop() -> __import__(\"rclpy\").spin(Teleop())", "call"),
        ("2: from std_msgs.msg import Float64 -> "
         "from std_msgs.msg import Float64; from std_msgs.msg import Float32 as Float64", "type"),
        ("18:             self.timer.cancel() -> "
         "            self.publisher.publish(Twist())\n            self.timer.cancel()", "command"),
        ("22:         response.success = True -> "
         "        response.success = True\n        return response", "return"),
        ("25:         return Result() ->         goal_handle.succeed()\n        return Result()", "goal"),
        ("9:         listener = TransformListener(self.buffer, self) -> "
         "        listener = TransformListener(self.buffer, self)\n        self._kept_listener = listener", "kept"),
        ("22:         response.success = True ->         pass", "deleted"),
    ],
)  # fmt: skip
def test_edits_that_mend_a_node(change, operator):
    assert changes(NODE).get(change) == operator


def test_what_is_left_in_peace():
    found = changes(NODE)
    assert not [each for each in found if each.startswith('7: "teleop"')]
    assert not [each for each in found if "create_publisher" in each and ("float(" in each or "-> pass" in each)]
    assert not [each for each in found if "8: 10 -> 5" in each]
    assert "15: 5.7 -> -5.7" not in changes(NODE, known=None)


@pytest.mark.parametrize(
    "change",
    [
        "4: ROS_TO_GZ -> GZ_TO_ROS",
        "1: /scan -> /lidar/scan",
        "2: gz.msgs.LaserScan\n  gz_type_name: sensor_msgs/msg/LaserScan -> "
        "sensor_msgs/msg/LaserScan\n  gz_type_name: gz.msgs.LaserScan",
    ],
)
def test_edits_that_mend_a_bridge(change):
    assert change in changes(BRIDGE, "bridge.yaml")


@pytest.mark.parametrize(
    "change", ["1: ${gap / 2} -> ${gap}", "2: -4 -> 4", "2: /cmd_val -> /cmd_vel", '1: <link name="base"/> -> ']
)
def test_edits_that_mend_a_robot(change):
    found = changes(XACRO, "robot.urdf.xacro")
    assert change in found
    assert not [each for each in found if each.startswith("1: 7 ")], "a comment was edited"


def test_a_file_that_cannot_be_read_has_no_edits():
    assert edits_of("node.py", b"def f(:", KNOWN) == []
    assert edits_of("bridge.yaml", b"a: [", KNOWN) == []
    assert edits_of("notes.txt", b"0.5", KNOWN) == []
    assert edits_of("node.py", "# coding: latin-1\nx = 'é'\n".encode("latin-1"), KNOWN) == []


def test_every_edit_of_a_solution_is_one_place_of_it_and_can_be_read():
    paths = [*ROOT.glob("solutions/*/*.py"), *ROOT.glob("solutions/*/*.yaml")]
    assert len(paths) > 10
    for path in paths:
        content = path.read_bytes()
        edits = edits_of(path.name, content, KNOWN)
        assert edits or not yaml.safe_load(content)
        for edit in edits[::7]:
            assert edit.content == content[: edit.begin] + edit.now.encode() + content[edit.end :]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", SyntaxWarning)
                _ = ast.parse(edit.content) if path.suffix == ".py" else yaml.safe_load(edit.content)


def test_two_edits_of_a_file():
    content = b"a = 1\nb = 2\n"
    one, two = (next(e for e in edits_of("x.py", content, KNOWN) if e.was == was and e.now == "3") for was in "12")
    assert both(content, two, one) == both(content, one, two) == b"a = 3\nb = 3\n"
    assert both(content, one, one) is None
