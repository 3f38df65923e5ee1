"""Rates that go into the bias also in the messages in which the heading grows."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
class Robot:
    def on_imu(self, message):
        now = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        rate = message.angular_velocity.z
        {before}
        if now < 1.0:
            {standing}
        elif self.heading is None:
            self.heading = 0.0
        else:
            self.heading += (rate - {bias}) * (now - self.last)
        self.last = now
"""
WORDS = "is done while the robot turns, too"
MEAN = "sum(self.rates) / len(self.rates)"


@pytest.mark.parametrize(
    ("before", "standing", "bias", "accused"),
    [
        ("pass", "self.rates.append(rate)", MEAN, False),
        ("self.rates.append(rate)", "pass", MEAN, True),
        ("self.rates.append(message.angular_velocity.z)", "pass", "np.mean(self.rates)", True),
        ("if now < 1.0:\n            self.rates.append(rate)\n            return", "pass", MEAN, False),
        ("self.rates.append(rate)", "self.bias = " + MEAN, "self.bias", False),
        ("self.total += rate\n        self.number += 1\n        bias = self.total / self.number", "pass", "bias", True),
        ("self.bias = 0.98 * self.bias + 0.02 * rate", "pass", "self.bias", True),
        ("pass", "self.bias = 0.9 * self.bias + 0.1 * rate", "self.bias", False),
        ("self.all.append(rate)\n        self.bias = np.mean(self.all)", "pass", "self.bias", True),
    ],
)
def test_when_the_bias_is_collected(before, standing, bias, accused):
    text = FILE.format(before=before, standing=standing, bias=bias)
    said = [each["said"] for each in suspects(text.encode()) if each["about"] == "gyroscope"]
    assert (bool(said) and WORDS in said[0]) == accused, said
