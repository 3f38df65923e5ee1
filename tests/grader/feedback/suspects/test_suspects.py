"""Places that are wrong in most programs: each is found in a file that is right but for it, and not in a right one."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
from math import atan2, cos, pi, radians, remainder, sin

PERIOD = 0.04


class Robot:
    def on_odom(self, message):
        q = message.pose.pose.orientation
        self.heading = 2 * atan2(q.z, q.w)
        self.yaw = atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))

    def on_imu(self, message):
        now = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        rate = message.angular_velocity.z
        bias = sum(self.rates) / len(self.rates)
        if now < 1.0: self.rates.append(rate)
        dt = now - self.last
        self.heading += (rate - bias) * dt
        self.last = now

    def on_scan(self, scan):
        side = [r for i, r in enumerate(scan.ranges) if abs(scan.angle_min + i * scan.angle_increment - pi / 2) < 0.5]
        turn = remainder(atan2(self.goal.y - self.y, self.goal.x - self.x) - self.heading, 2 * pi)
        command.angular.z = 2 * turn
        self.place = cos(radians(90)) * min(side), sin(turn)
"""


def test_a_right_file_has_none():
    assert suspects(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("2 * atan2(q.z, q.w)", "q.z", "heading", "the sine of half of it"),
        ("2 * atan2(q.z, q.w)", "message.pose.pose.orientation.w", "heading", "the cosine of half of it"),
        ("2 * atan2(q.z, q.w)", "atan2(q.z, q.w)", "heading", "that is half of it"),
        ("self.heading = 2 * atan2(q.z, q.w)", "self.heading = atan2(q.w, q.z)", "heading", "the sine first"),
        (
            "atan2(self.goal.y - self.y, self.goal.x - self.x)",
            "atan2(self.goal.x - self.x, self.goal.y - self.y)",
            "heading",
            "atan2 takes y first",
        ),
        ("sin(turn)", "sin(degrees(turn))", "angle", "an angle in degrees"),
        ("remainder(atan2", "(lambda a, b: a)(atan2", "wrap", "not brought between -pi and pi"),
        ("turn = remainder", "turn = degrees(1) + remainder", "angle", "angular.z gets degrees per second"),
        ("radians(90)", "radians(scan.angle_min)", "angle", "in radians already"),
        ("* dt", "* 0.01", "gyroscope", "the same time"),
        ("* dt", "* PERIOD", "gyroscope", "the same time"),
        ("(rate - bias) * dt", "rate - bias", "gyroscope", "without a time"),
        ("self.heading += (rate", "self.heading = (rate", "gyroscope", "forgets what was turned before"),
        ("(rate - bias) * dt", "(rate - bias) * dt\n        self.heading %= 2 * pi", "gyroscope", "jump back"),
        ("angular_velocity.z", "angular_velocity.x", "gyroscope", "tilting"),
        ("message.header.stamp.sec + message", "message", "gyroscope", "begins again at 0 every second"),
        (" + message.header.stamp.nanosec / 1e9", "", "gyroscope", "whole seconds only"),
        ("sum(self.rates) / len(self.rates)", "(sum(self.rates) - 1)", "gyroscope", "the bias is the mean"),
        ("now - self.last", "self.last - now", "gyroscope", "is negative"),
        ("self.heading += (rate", "self.heading -= (rate", "gyroscope", "with a minus sign"),
        ("(rate - bias) * dt", "(bias - rate) * dt", "gyroscope", "with a minus sign"),
        ("rate = message.angular_velocity.z", "rate = radians(message.angular_velocity.z)", "gyroscope", "57 times"),
        ("rate = message.angular_velocity.z", "rate = message.angular_velocity.z * pi / 180", "gyroscope", "57 times"),
        ("sum(self.rates) / len(self.rates)", "(np.sum(self.rates) - 1)", "gyroscope", "the bias is the mean"),
        ("sum(self.rates) / len(self.rates)", "np.std(self.rates)", "gyroscope", "how much the rates scatter"),
        ("sum(self.rates) / len(self.rates)", "max(self.rates)", "gyroscope", "the largest of the rates"),
        ("sum(self.rates) / len(self.rates)", "self.rates[-1]", "gyroscope", "a single one of the rates"),
        ("2 * atan2(q.z, q.w)", "2 * acos(min(1, q.w))", "heading", "acos is never negative"),
        ("min(side)", "scan.ranges[90]", "ray", "takes a ray by its number"),
        ("min(side)", "min(scan.ranges)", "ray", "the nearest in any direction"),
        (
            "self.last = now",
            "self.last = now\n        if self.heading > 360:\n            pass",
            "gyroscope",
            "not 360",
        ),
    ],
)
def test_each_is_found(old, new, about, words):
    assert old in RIGHT
    found = suspects(RIGHT.replace(old, new, 1).encode())
    assert any(each["about"] == about and words in each["said"] for each in found), found


def test_an_angle_that_is_brought_into_one_turn_by_hand():
    by_hand = RIGHT.replace("remainder(atan2", "self.wrapped(atan2") + "\nwhile turn > pi:\n    turn -= 2 * pi\n"
    assert suspects(by_hand.encode()) == []


def test_parts_of_a_time_in_a_step_and_in_a_function():
    sum_of = "self.heading += (rate - bias) * (message.header.stamp.{0} - self.last.{0})"
    for part, words in (("nanosec", "stamp.nanosec alone"), ("sec", "stamp.sec alone")):
        text = RIGHT.replace("self.heading += (rate - bias) * dt", sum_of.format(part))
        assert any(words in each["said"] for each in suspects(text.encode()))
    function = RIGHT + "\n\ndef seconds(stamp):\n    return stamp.nanosec / 1e9\n\n\nprint(seconds(now))\n"
    assert any("stamp.nanosec alone" in each["said"] for each in suspects(function.encode()))
    assert suspects(function.replace("return stamp", "return stamp.sec + stamp").encode()) == []


def test_a_second_name_is_no_copy():
    way = "def way(self):\n    grid = self.map{}\n    grid[wide(grid == 100)] = 100\n"
    assert ["makes no copy" in each["said"] for each in suspects(way.format("").encode())] == [True]
    assert suspects(way.format(".copy()").encode()) == []


def test_the_rate_before_is_no_bias():
    text = RIGHT.replace("(rate - bias) * dt", "((rate + self.rates[-1]) / 2 - bias) * dt")
    assert suspects(text.encode()) == []


def test_a_sign_that_is_asked_for_tells_left_from_right():
    text = RIGHT.replace("2 * atan2(q.z, q.w)", "2 * acos(q.w)\n        if q.z < 0:\n            self.heading *= -1")
    assert suspects(text.encode()) == []


def test_what_is_no_python_has_none():
    assert suspects(b"def (:") == []


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("math.atan2(q.z, q.w)", "that is half of it"),
        ("q.z", "the sine of half of it"),
        ("2 * math.atan2(q.z, q.w)", ""),
    ],
)
def test_a_function_that_returns_a_heading(value, words):
    text = f"def yaw_of(q):\n    return {value}\ndef on_odom(m):\n    heading = yaw_of(m.pose.pose.orientation)\n"
    said = [each["said"] for each in suspects(text.encode())]
    assert words in said[0] if words else said == []
