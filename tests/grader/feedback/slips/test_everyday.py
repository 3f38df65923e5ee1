"""Mistakes of a first month, each in a file that is right but for it."""

import pytest

from gz_course.grader.feedback.facts.clocks import time_reckoning
from gz_course.grader.feedback.slips import slips

RIGHT = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32, String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(Float32, "/x", 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.start = None

    def tick(self):
        now = self.get_clock().now()
        self.start = self.start or now
        message = Float32(data=0.5)
        self.get_logger().info(f"at {now}")
        self.publisher.publish(message)
        self.timer.cancel()


def main():
    rclpy.init()
    rclpy.spin(Talker())


if __name__ == "__main__":
    main()
"""


def test_a_right_file_has_none():
    assert slips(RIGHT.encode()) == [] and time_reckoning(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("def __init__", "def _init_", "the constructor is __init__"),
        ("at {now}", "at {now.intensities}", "in ranges"),
        ('"__main__"', '"main"', "this condition, __name__ == 'main', never runs"),
        ("self.publisher.publish(message)", "return\n        self.publisher.publish(message)", "this line never runs"),
        ("rclpy.spin(Talker())", "try:\n        rclpy.spin(a)\n    finally:\n        a.tick()", "tick() comes after"),
        ("spin(Talker())", "spin(Talker())\n    tick()", "tick() comes after spin()"),
        ("self.start = None", "self.timer.cancel()", "self.timer is cancelled in __init__"),
        ("self.start = None", "self.again = self.create_timer(1.0, self.tick)", "two timers call self.tick"),
        ("self.publisher.publish(message)", "rclpy.shutdown()\n        self.publisher.publish(message)", "exchange"),
        ("self.start = self.start or now", "if self.start:\n            self.start = now", "below  if self.start:"),
        (
            "self.start = self.start or now",
            "self.n += 1\n        if self.n == 100:\n            pass",
            "self.n is 100 only after 100 ticks of 0.1 s, which take 10 s",
        ),
        ("\n    main()", "\n    pass", "nothing calls it"),
        ("\n    main()", "\n    main", "main without brackets"),
        ("self.timer.cancel()", "self.timer.cancel", "self.timer.cancel without brackets"),
        ("0.1, self.tick", "0.1, self.tick()", "the callback itself is self.tick, without brackets"),
        ("(0.1, self", "(1000, self", "the timer's period is in seconds"),
        ("(0.1, self", "(0,1, self", "a point, 0.1"),
        ("message = Float32(data=0.5)", "message = Float32()\n        message.data = 0,5", "a point, 0.5"),
        ("data=0.5", "data={self.x}", "{self.x} is a set"),
        ('f"at {now}"', '"at {now}"', "has no f before its quotes"),
        ("    def tick", "def tick", "is no method of the class"),
        ("        self.timer.cancel()", "        while rclpy.ok():\n            self.publish()", "keeps the executor"),
        (
            "        self.timer.cancel()",
            "        rate = self.create_rate(10)\n        while True:\n            rate.sleep()",
            "keeps the executor",
        ),
    ],
)
def test_each_is_named_with_its_line(old, new, words):
    assert old in RIGHT
    text = RIGHT.replace(old, new)
    if new == "def tick":
        text = text[: text.index("def tick")] + "def tick(self):\n    pass\n"
    found = slips(text.encode())
    assert [place for place in found if words in place["said"] and place["line"] > 1], found


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("self.elapsed += 0.1", "ticks"),
        ("self.ticks = self.ticks + 1", "ticks"),
        ("self.left -= 1", "ticks"),
        ("now = self.get_clock().now().seconds_nanoseconds()[1]", "nanosec"),
        ("now = self.get_clock().now().seconds_nanoseconds()[0]", "sec"),
        ("now = message.header.stamp.nanosec", "nanosec"),
        ("now = self.get_clock().now().to_msg().sec", "sec"),
    ],
)
def test_time_that_is_reckoned_wrongly(line, fault):
    body = RIGHT[RIGHT.index("        now") : RIGHT.index("\n\ndef main")]
    found = time_reckoning(RIGHT.replace(body, f"        {line}\n").encode())
    assert [place["fault"] for place in found] == [fault]
    assert found[0]["line"] == 14


WAITS = "self.buffer.lookup_transform('odom', 'lidar', now, Duration(seconds=1))"


@pytest.mark.parametrize(
    "call", [WAITS, "self.buffer.can_transform('a', 'b', now, timeout=wait)", "self.buffer.transform(p, 'a', wait)"]
)
def test_a_lookup_that_keeps_the_only_thread(call):
    text = RIGHT.replace("message = ", f"{call}\n        message = ")
    assert ["keeps the only thread" in place["said"] for place in slips(text.encode())] == [True]
    for thread in ("MultiThreadedExecutor(2)", "Thread(target=f)", "TransformListener(b, n, spin_thread=True)"):
        assert slips(text.replace("rclpy.init()", thread).encode()) == []
    assert slips(text.replace(call, "self.buffer.lookup_transform('a', 'b', now)").encode()) == []


def test_counters_beside_a_clock_and_in_loops_are_no_fault():
    assert time_reckoning(RIGHT.replace("now = ", "self.n += 1\n        now = ").encode()) == []
    loop = "        for each in (1, 2):\n            self.n += 1\n"
    body = RIGHT[RIGHT.index("        now") : RIGHT.index("\n\ndef main")]
    assert time_reckoning(RIGHT.replace(body, loop).encode()) == []


@pytest.mark.parametrize("text", [b"", b"def", b"\x00", b"(" * 5000])
def test_what_is_not_python_has_none(text):
    assert slips(text) == [] and time_reckoning(text) == []


@pytest.mark.parametrize(("seconds", "named"), [(1000, True), (1.0, False)])
def test_a_sleep_of_minutes_before_publish_is_named(seconds, named):
    text = f"import time\n\np = node.create_publisher(String, '/a', 10)\ntime.sleep({seconds})\np.publish(a)"
    found = [place["line"] for place in slips(text.encode()) if "takes seconds" in place["said"]]
    assert found == ([4] if named else [])


def test_an_executor_that_nothing_spins_is_named():
    text = "executor = SingleThreadedExecutor()\nexecutor.add_node(node)\n"
    assert [place["line"] for place in slips(text.encode()) if "executor.spin() is missing" in place["said"]] == [2]
    assert not slips(f"{text}executor.spin()\n".encode())
