"""An angle that is set back in each message, that counts another time, or that is an orientation."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """
class A:
    def __init__(self):
        self.heading = 0.0
        self.create_timer(0.1, self.add)

    def on_imu(self, message):
        now = Time.from_msg(message.header.stamp)
        self.rate = message.angular_velocity.z - self.bias
        self.bias = self.bias

    def add(self):
        self.heading += self.rate * {step}

    def on_other(self, message):
        {first}
        self.turned += message.angular_velocity.z * (stamp(message) - self.last)
"""


def test_a_rate_that_is_kept_is_no_sum():
    node = NODE.format(step="0.1", first="pass").replace("self.bias\n", "np.mean(self.rates)\n", 1)
    assert not any("without a time" in each["said"] for each in suspects(node.encode()))


@pytest.mark.parametrize(
    ("step", "first", "words"),
    [
        ("0.1", "pass", ""),
        ("0.05", "pass", "counts 0.05 s for each call, and the timer calls add every 0.1 s"),
        ("0.1", "self.turned = 0.0", "self.turned = 0.0 is done before each step is added"),
        ("0.1", "self.steps = 0", ""),
        ("0.1", "if self.turned is None: self.turned = 0.0; self.turned += self.first", ""),
    ],
)
def test_sums(step, first, words):
    said = [each["said"] for each in suspects(NODE.format(step=step, first=first).encode())]
    assert [words in each for each in said if "0.0 is done" in each or "counts 0" in each] == [True] * bool(words), said


def test_an_orientation_in_place_of_rates():
    node = "class A:\n    def __init__(self):\n        self.create_subscription({}, '/imu', self.on_it, 10)\n"
    node += "    def on_it(self, message):\n        self.heading = 2 * atan2(message.orientation.z, message.{}.w)\n"
    said = [each["said"] for each in suspects(node.format("Imu", "orientation").encode())]
    assert len(said) == 1 and "never comes to 2 pi" in said[0]
    assert suspects(node.format("Odometry", "orientation").encode()) == []
    rates = suspects(node.replace("{}.w", "angular_velocity.z").format("Imu").encode())
    assert not any("never comes to 2 pi" in each["said"] for each in rates)
