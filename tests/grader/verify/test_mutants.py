"""Mutants: one place spoilt, the rest of the file as it was; few of them chosen, always the same."""

import ast

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.edits import Edit, edits_of
from gz_course.grader.verify.mutants import choose

NODE = '''\
"""A docstring, 0.5 and /cmd_vel in it."""

import rclpy
from geometry_msgs.msg import Twist


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)

    def on_scan(self, scan):
        valid = [r for r in scan.ranges if scan.range_min < r < 9.5]
        if not valid or len(valid) == 3:
            return
        command = Twist()
        command.linear.x = 0.5 - min(valid)
        self.publisher.publish(command)
        self.get_logger().info(f"ä: {len(valid):.2f} at {-1.5}")


if __name__ == "__main__":
    main(num_threads=2)
'''


def changes(text=NODE, file="node.py"):
    return {mutant.change: mutant for mutant in edits_of(file, text.encode())}


@pytest.mark.parametrize(
    ("change", "operator"),
    [
        ("""10: "/cmd_vel" -> '/cmd_ve'""", "name"),
        ("""11: "/scan" -> '/sca'""", "name"),
        ("14: scan.range_min < r < 9.5 -> scan.range_min < r", "comparison"),
        ("14: scan.range_min < r < 9.5 -> r < 9.5", "comparison"),
        ("14: scan.range_min < r < 9.5 -> True", "condition"),
        ("14: scan.range_min -> scan.range_max", "field"),
        ("14: 9.5 -> (-9.5)", "sign"),
        ("14: 9.5 -> 19.0", "number"),
        ("15: not valid or len(valid) == 3 -> False", "condition"),
        ("15: not valid -> (valid)", "logic"),
        ("15: len(valid) == 3 -> len(valid) != 3", "comparison"),
        ("18: 0.5 - min(valid) -> (0.5 + min(valid))", "sign"),
        ("18: min -> max", "call"),
        ("18: command.linear.x = 0.5 - min(valid) -> pass", "forgotten"),
        ("19: self.publisher.publish(command) -> pass", "forgotten"),
        ("20: -1.5 -> (1.5)", "sign"),
    ],
)
def test_the_mistakes_of_students_are_among_them(change, operator):
    assert changes()[change].operator == operator


def test_qos_is_mutated_to_what_does_not_connect():
    qos = {m.line: m.now for m in changes().values() if m.operator == "qos"}
    assert "qos_profile_sensor_data" in qos[10] and "TRANSIENT_LOCAL" in qos[11]


def test_comparisons_are_turned_round():
    text = "a is None\nb is not None\nc in d\ne not in f\ng >= 1\nh != 2\nk = not m\n"
    now = {mutant.line: mutant.now for mutant in changes(text).values() if mutant.operator in ("comparison", "logic")}
    assert now == {
        1: "a is not None",
        2: "b is None",
        3: "c not in d",
        4: "e in f",
        5: "g < 1",
        6: "h == 2",
        7: "(m)",
    }


def test_what_says_nothing_about_a_node_is_left_alone():
    told = " ".join(changes())
    for word in ("docstring", "teleop", "__main__", "num_threads", "1: "[:0] or "ä"):
        assert word not in told
    assert not any(mutant.line in (1, 9, 23, 24) for mutant in changes().values())


def test_every_mutant_is_python_and_differs_in_one_line_only():
    for mutant in changes().values():
        ast.parse(mutant.content)
        before, after = NODE.splitlines(), mutant.content.decode().splitlines()
        assert len(before) == len(after)
        assert [i for i, (a, b) in enumerate(zip(before, after, strict=True), 1) if a != b] == [mutant.line], mutant


@given(st.integers(1, 40), st.permutations(range(40)))
def test_the_choice_depends_on_nothing_but_the_mutants(most, order):
    every = [Edit("f.py", i, f"operator {i % 7}", f"{i}", f"{i + 1}", b"%d" % i) for i in range(40)]
    chosen = choose([every[i] for i in order], most)
    assert chosen == choose(every, most)
    assert len(chosen) == most and chosen == sorted(chosen, key=lambda mutant: mutant.line)
    counts = [sum(m.operator == f"operator {k}" for m in chosen) for k in range(7)]
    assert max(counts) - min(counts) <= 1 or most > 35, "every operator has its turn"


BRIDGE = """\
# ä
- ros_topic_name: /scan
  gz_topic_name: "/lidar/scan"
  ros_type_name: sensor_msgs/msg/LaserScan
  direction: GZ_TO_ROS
  lazy: true
  publisher_queue: 5
- ros_topic_name: /odom
  direction: BIDIRECTIONAL
"""


@pytest.mark.parametrize(
    ("change", "operator"),
    [
        ("2: /scan -> /sca", "name"),
        ("""3: "/lidar/scan" -> '/lidar/sca'""", "name"),
        ("4: sensor_msgs/msg/LaserScan -> sensor_msgs/msg/LaserSca", "type"),
        ("5: GZ_TO_ROS -> ROS_TO_GZ", "direction"),
        ("6: true -> false", "switch"),
        ("7: 5 -> 10", "number"),
        ("9: BIDIRECTIONAL -> GZ_TO_ROS", "direction"),
    ],
)
def test_the_mistakes_in_yaml(change, operator):
    assert changes(BRIDGE, "bridge.yaml")[change].operator == operator


def test_an_entry_of_yaml_is_forgotten():
    left = [yaml.safe_load(m.content) for m in changes(BRIDGE, "b.yaml").values() if m.operator == "forgotten"]
    whole = yaml.safe_load(BRIDGE)
    assert whole[1:] in left and all(len(entries) == 1 and entries[0] in whole for entries in left)


def test_every_mutant_of_yaml_is_yaml():
    for mutant in changes(BRIDGE, "bridge.yaml").values():
        assert yaml.safe_load(mutant.content) != yaml.safe_load(BRIDGE)


def test_a_file_of_another_sort_has_none():
    assert [m.now for m in edits_of("switch.yaml", b"lazy: false")] == ["true"]
    assert edits_of("notes.txt", b"0.5") == []
    assert edits_of("empty.yaml", b"") == edits_of("empty.py", b"") == []
