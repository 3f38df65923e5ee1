"""A bias that is taken for an angle, or measured and not used."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
class Robot:
    def on_imu(self, message):
        now = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        rate = message.angular_velocity.z
        if now < 1.0:
            self.samples += 1
            self.bias += (rate - self.bias) / self.samples
        elif self.heading is None:
            self.heading = 0.0
        else:
            self.heading += (rate - self.bias) * (now - self.last)
        self.last = now
"""


@pytest.mark.parametrize(
    "step",
    [
        "(rate - self.bias) * (now - self.last)",
        "rate * (now - self.last) - self.bias * (now - self.last)",
        "-(self.bias - rate) * (now - self.last)",
    ],
)
def test_right_ways(step):
    assert suspects(FILE.replace("(rate - self.bias) * (now - self.last)", step).encode()) == []


def test_a_bias_of_the_angle():
    without = FILE.replace("(rate - self.bias) * (now", "rate * (now")
    for text, words in (
        (without.replace("self.heading = 0.0", "self.heading = -self.bias"), "from the angle [rad], once"),
        (
            FILE.replace("(rate - self.bias) * (now - self.last)", "rate * (now - self.last) - self.bias"),
            "an angle [rad]",
        ),
        (without, "self.bias is measured here and subtracted nowhere"),
    ):
        found = suspects(text.encode())
        assert [each["about"] for each in found] == ["gyroscope"] and words in found[0]["said"], found


def test_a_sum_is_no_mean():
    summed = FILE.replace("(rate - self.bias) / self.samples", "rate")
    assert ["is the sum of the rates" in each["said"] for each in suspects(summed.encode())] == [True]
    divided = summed.replace("self.heading = 0.0", "self.heading = 0.0; self.bias /= self.samples")
    assert suspects(divided.encode()) == []
    assert suspects(summed.replace("(rate - self.bias) *", "(rate - self.bias / self.samples) *").encode()) == []
