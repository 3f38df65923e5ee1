"""Where a file gives a whole number to a field of floats: as an assignment or a keyword, and nowhere else."""

import pytest
from geometry_msgs.msg import Twist
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from gz_course.grader.feedback.facts.whole_numbers import whole_numbers
from gz_course.grader.feedback.slips import slips
from gz_course.grader.run.message_fields import float_fields, message_fields

FIELDS = {"Twist": {"linear.x", "angular.z"}, "Vector3": {"x", "y", "z"}, "Float32": {"data"}}


def test_rclpy_really_loses_a_whole_number():
    twist = Twist()
    twist.linear.x = 1
    assert abs(deserialize_message(serialize_message(twist), Twist).linear.x) < 1e-300


def test_the_fields_of_a_type_and_of_its_parts():
    fields = float_fields(["geometry_msgs/msg/Twist", "std_msgs/msg/Float32", "std_msgs/msg/Int32", "no_msgs/msg/Such"])
    both = {f"{part}.{axis}" for part in ("linear", "angular") for axis in "xyz"}
    assert fields == {"Twist": both, "Vector3": set("xyz"), "Float32": {"data"}, "Int32": set()}


@pytest.mark.parametrize(
    ("text", "field", "value"),
    [
        ("#\ncommand.linear.x = 1", "command.linear.x", "1"),
        ("#\ncommand.linear.x = '0.5'", "command.linear.x", "'0.5'"),
        ("#\nself.command.angular.z = -2", "self.command.angular.z", "-2"),
        ("#\nt.linear.x = 1 if go else 0", "t.linear.x", "1 if go else 0"),
        ("SPEED = 1\nt.linear.x = SPEED", "t.linear.x", "SPEED"),
        ("self.speed = 2 * 3\nt.linear.x = -self.speed", "t.linear.x", "-self.speed"),
        ("#\nTwist(linear=Vector3(x=1))", "Vector3.x", "1"),
        ("#\nstd_msgs.msg.Float32(data=int(nearest))", "Float32.data", "int(nearest)"),
        ("#\nmessage.data = round(nearest)", "message.data", "round(nearest)"),
    ],
)
def test_it_is_found_with_its_line(text, field, value):
    assert whole_numbers(text.encode(), FIELDS) == [{"line": 2, "field": field, "value": value}]


@pytest.mark.parametrize(
    "text",
    [
        "t.linear.x = 1.0",
        "t.linear.x = 0",  # arrives as 0
        "t.linear.x = 1 / 2",
        "t.linear.x = float(1)",
        "t.linear.x = round(distance, 1)",
        "speed = 1\nspeed = 0.5\nt.linear.x = speed",
        "speed = 1\nspeed *= 0.5\nt.linear.x = speed",
        "def drive(speed):\n    t.linear.x = speed",
        "t.header.x = 1",
        "self.data = 1",
        "from std_msgs.msg import Int32\nm.data = 1",
        "from std_msgs.msg import String\nm.data = 'x'",
        "String(data=1)",
        "String(data='0.5')",
        "def",
        "\x00",
    ],
)
def test_what_is_no_such_place(text):
    assert whole_numbers(text.encode(), FIELDS) == []


@given(st.binary(max_size=200))
def test_no_content_breaks_it(content):
    assert whole_numbers(content, FIELDS) == []


@pytest.mark.parametrize("value", ["None", "True", "[0.5]", "(0.5,)", "self.get_parameter('speed')"])
def test_what_is_no_number_at_all_is_found(value):
    found = whole_numbers(f"command = Twist()\ncommand.linear.x = {value}\n".encode(), FIELDS)
    assert [place["line"] for place in found] == [2]


def test_a_field_that_a_message_does_not_have():
    fields = message_fields(["geometry_msgs/msg/Twist", "std_msgs/msg/String", "no/msg/Such"])
    text = b"a = String(text='hi')\nb = Twist(linear_x=0.5)\nc = Twist(linear=Vector3(x=1.0))\nd = String(data='hi')\n"
    assert [place["line"] for place in slips(text, 8.0, fields)] == [1, 2]
    assert "a String has no field text: it is called data" in slips(text, 8.0, fields)[0]["said"]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("from rclpy.time import Time\nt = Time(seconds=3)", False),
        ("import rclpy.time\nt = rclpy.time.Time(seconds=3)", False),
        ("from collections import namedtuple\nTime = namedtuple('Time', 'seconds')\nt = Time(seconds=3)", False),
        ("from builtin_interfaces.msg import Time\nt = Time(seconds=3)", True),
        ("import builtin_interfaces.msg as b\nt = b.Time(seconds=3)", True),
        ("from builtin_interfaces import msg\nt = msg.Time(seconds=3)", True),
    ],
)
def test_a_class_of_the_same_name_is_no_message(text, found):
    fields = message_fields(["std_msgs/msg/Header"])
    assert any("has no field seconds" in place["said"] for place in slips(text.encode(), 8.0, fields)) is found


def test_a_file_far_longer_than_a_solution_is_not_looked_through():
    assert slips(b"x == 1\n" * 10) and slips(b"x == 1\n" * 4000) == []
