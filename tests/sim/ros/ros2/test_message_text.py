"""Messages as YAML and CSV."""

import math

import yaml
from geometry_msgs.msg import Pose, PoseArray
from hypothesis import example, given
from hypothesis import strategies as st
from sensor_msgs.msg import Imu, LaserScan
from std_msgs.msg import Byte, Header, String

from gz_course.sim.ros.ros2.message_text import TextFormat, to_csv, to_yaml


def test_fields_come_in_the_order_of_the_definition_with_floats_as_they_are():
    scan = LaserScan(range_max=float("inf"), ranges=[0.5, float("nan"), float("-inf")])
    scan.header.frame_id = "lidar"
    assert to_yaml(scan, TextFormat()) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: lidar\n"
        "angle_min: 0.0\nangle_max: 0.0\nangle_increment: 0.0\ntime_increment: 0.0\nscan_time: 0.0\n"
        "range_min: 0.0\nrange_max: .inf\nranges:\n- 0.5\n- .nan\n- -.inf\nintensities: []\n"
    )


def test_long_values_are_cut():
    scan = LaserScan(ranges=[1.0] * 200)
    assert yaml.safe_load(to_yaml(scan, TextFormat()))["ranges"] == [1.0] * 128 + ["..."]
    assert yaml.safe_load(to_yaml(scan, TextFormat(limit=None)))["ranges"] == [1.0] * 200
    assert yaml.safe_load(to_yaml(LaserScan(ranges=[1.0] * 128), TextFormat()))["ranges"] == [1.0] * 128
    assert to_yaml(String(data="abcdef"), TextFormat(limit=3)) == "data: abc...\n"
    assert to_csv(LaserScan(ranges=[1.0, 2.0]), TextFormat(limit=1)).endswith(",1.0,...")


def test_arrays_and_strings_can_be_left_out():
    imu = yaml.safe_load(to_yaml(Imu(), TextFormat(arrays=False)))
    assert imu["orientation_covariance"] == "<array type: double[9]>"
    scan = yaml.safe_load(to_yaml(LaserScan(ranges=[1.0]), TextFormat(arrays=False)))
    assert scan["ranges"] == "<sequence type: float, length: 1>"
    header = yaml.safe_load(to_yaml(Header(frame_id="lidar"), TextFormat(strings=False)))
    assert header["frame_id"] == "<string length: <5>>"


def test_flow_style_puts_the_innermost_collections_in_one_line():
    assert to_yaml(Header(), TextFormat(flow_style=True)) == "stamp: {sec: 0, nanosec: 0}\nframe_id: ''\n"


def test_a_message_that_occurs_twice_is_written_twice():
    pose = Pose()
    poses = yaml.safe_load(to_yaml(PoseArray(poses=[pose, pose]), TextFormat()))["poses"]
    assert poses[0] == poses[1]
    assert "&" not in to_yaml(PoseArray(poses=[pose, pose]), TextFormat())


def test_a_byte_is_a_character():
    assert to_yaml(Byte(data=b"A"), TextFormat()) == "data: A\n"


def test_csv_has_every_value_once():
    header = Header(frame_id="lidar")
    header.stamp.sec = 7
    assert to_csv(header, TextFormat()) == "7,0,lidar"


# YAML treats the line breaks of Unicode as its own.
@example("a\x85b")
@example("\u2028")
@example("a\u2029")
@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=300))
def test_any_text_survives(text):
    assert yaml.safe_load(to_yaml(String(data=text), TextFormat(limit=None)))["data"] == text


@given(st.lists(st.floats(width=32), max_size=20))
def test_any_numbers_survive(numbers):
    shown = yaml.safe_load(to_yaml(LaserScan(ranges=numbers), TextFormat()))["ranges"]
    assert all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(shown, numbers, strict=True))
