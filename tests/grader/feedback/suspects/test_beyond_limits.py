"""What raises a command beyond its limit is found where it is the only way to do so."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from math import cos

from sensor_msgs.msg import LaserScan

MOST = 1.5


def saturate(value, most):
    return max(-most, min(most, value))


class Follower:
    def on_scan(self, scan):
        limit = self.get_parameter("speed_limit").value
        sign = 1.0 if self.get_parameter("side").value == "left" else -1.0
        nearest, away = self.nearest(scan)
        near = saturate(4.0 * (nearest - 0.6), MOST)
        turned = saturate(2.0 * away, 1.5)
        {turning}
        {speed}
        self.publisher.publish(command)

    def send(self, rate):
        {send}

    def nearest(self, scan):
        return min(scan.ranges), 0.1
"""
RIGHT = {
    "turning": "command.angular.z = sign * saturate(near + turned, MOST)",
    "speed": "command.linear.x = limit * max(0.1, cos(away)) * (1 - 0.5 * abs(near) / MOST)",
    "send": "pass",
}


def found(about, **changed):
    found = suspects(FILE.format(**RIGHT | changed).encode())
    return [each["said"] for each in found if each["about"] == about]


@pytest.mark.parametrize(
    "turning",
    [
        RIGHT["turning"],
        "turning = near + turned\n        turning = saturate(turning, MOST)\n        command.angular.z = turning",
        "turning = 0.4 * near + 0.5 * turned\n        command.angular.z = sign * turning",
        "turning = near + turned\n        if turning > MOST:\n            turning = MOST\n"
        "        elif turning < -MOST:\n            turning = -MOST\n        command.angular.z = turning",
        "self.last.append(near)\n        command.angular.z = sum(self.last) / len(self.last)",
        "command.angular.z = near * max(0.1, cos(away))",
        "self.send(saturate(near + turned, MOST))",
    ],
)
def test_right_rates(turning):
    assert found("limit", turning=turning, send="command.angular.z = rate" if "send" in turning else "pass") == []


@pytest.mark.parametrize(
    ("turning", "words"),
    [
        ("turning = near + turned\n        command.angular.z = sign * turning", "adds two terms that are limited each"),
        ("turning = near\n        turning += turned\n        command.angular.z = turning", "adds two terms"),
        ("command.angular.z = near + turned if sign > 0 else -(near + turned)", "may be 3.0 rad/s"),
        ("command.angular.z = turned + 3.0 * (nearest - 0.6)", "adds something to what is limited already"),
        ("command.angular.z = 2.0 * (away + nearest)", "is not limited at all"),
        ("command.angular.z = min(MOST, 2.0 * (away + nearest))", "limits it from above only"),
        ("command.angular.z = near if away > 0 else 2.2", "may be up to 2.20 rad/s"),
        (
            "turning = near + turned\n        if turning > MOST:\n            turning = MOST\n"
            "        command.angular.z = turning",
            "limits it on one side only",
        ),
        ("self.send(near + turned)", "adds two terms that are limited each"),
    ],
)
def test_rates_beyond_their_limit(turning, words):
    send = "command.angular.z = rate" if "send" in turning else "pass"
    (said,) = set(found("limit", turning=turning, send=send))
    assert words in said


@pytest.mark.parametrize(
    "speed",
    [
        RIGHT["speed"],
        "command.linear.x = min(limit, limit / cos(away))",
        "speed = limit / cos(away)\n        command.linear.x = min(speed, limit)",
        "command.linear.x = limit / 2 if abs(away) > 0.5 else limit",
        "command.linear.x = limit / (1 + abs(near))",
        "command.linear.x = limit * np.clip(cos(away), 0.1, 1.0)",
        "command.linear.x = limit * self.share(away)",
        "command.linear.x = self.settings['speed_limit'] * max(0.1, cos(away))",
        "command.linear.x = max(0.0, limit - 0.2 * abs(near))",
        "command.linear.x = 0.4 * limit + 0.6 * limit * cos(away)",
    ],
)
def test_right_speeds(speed):
    assert found("speed limit", speed=speed) == []


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        ("command.linear.x = limit / cos(away) if away < 0.9 else 0.3 * limit", "divides limit by cos(away)"),
        ("speed = limit\n        speed /= cos(away)\n        command.linear.x = speed", "which is 1 at most"),
        ("command.linear.x = limit * nearest", "multiplies limit by nearest, which is above 1 at times"),
        ("command.linear.x = limit * 1.2", "multiplies limit by 1.2"),
        ("command.linear.x = limit + 0.3 * (nearest - 0.6)", "to limit, which is the limit already"),
        ("command.linear.x = limit - 0.3 * (nearest - 0.6)", "which is below 0 at times"),
        ("command.linear.x = limit * (0.8 + 0.3 * abs(near))", "multiplies limit by 0.8 + 0.3 * abs(near)"),
        (
            "command.linear.x = limit\n        command.linear.x = max(command.linear.x, 0.35)",
            "may be 0.35 m/s, whatever speed_limit is",
        ),
        ("command.linear.x = limit if away < 0.5 else 0.4", "0.4 m/s, whatever speed_limit is"),
    ],
)
def test_speeds_beyond_their_limit(speed, words):
    (said,) = set(found("speed limit", speed=speed))
    assert words in said
