"""What raises no error and has no effect, or another one: each in a file that is right but for it."""

import pytest

from gz_course.grader.feedback.slips import slips

RIGHT = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

PERIOD = 0.1
SECONDS = 5.0


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(PERIOD, self.tick)
        self.start = None
        self.done = False

    def tick(self):
        now = self.get_clock().now()
        if self.start is None:
            self.start = now
        elapsed = (now - self.start).nanoseconds / 1e9
        command = Twist()
        if elapsed < SECONDS:
            command.linear.x = 0.5
        elif self.done:
            return
        else:
            self.done = True
        self.publisher.publish(command)

    def later(self, count):
        return self.tick

    def smallest(self, ranges):
        best = 9.0
        for each in ranges:
            best = min(best, each)
        return best


def main():
    rclpy.init()
    node = Teleop()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
"""
WRONG = {
    # time_units.py
    "the left side is in nanoseconds, and 5 of them are 5e-09 s": ("nanoseconds / 1e9", "nanoseconds"),
    "the left side is in milliseconds, and 5 of them are 0.005 s": ("/ 1e9", "/ 1e6"),
    "5000 s are waited for": ("SECONDS = 5.0", "SECONDS = 5000"),
    "the unit of the left side is 10 s, and 5 of them": ("/ 1e9\n", "/ 1e10\n"),
    "a time is hardly ever exactly this number": ("elapsed < SECONDS", "elapsed == SECONDS"),
    "Duration(nanoseconds=5) lasts 5e-09 s": ("elapsed < SECONDS", "now - self.start < Duration(nanoseconds=5)"),
    "self.start - now is negative": ("now - self.start", "self.start - now"),
    "a nanosecond is 1e-9 s": ("        best = 9.0", "        best = t.sec + t.nanosec / 1e6"),
    "t.sec + t.nanosec: a nanosecond is 1e-9 s": ("        best = 9.0", "        best = t.sec + t.nanosec"),
    # slips.py: periods
    "create_timer(PERIOD, which is 100, ...)": ("PERIOD = 0.1", "PERIOD = 100"),
    "10 times per second are create_timer(0.1, ...)": ("PERIOD = 0.1", "PERIOD = 10"),
    "1 // 10 is 0": ("create_timer(PERIOD", "create_timer(1 // 10"),
    # callbacks.py
    "names self.tick and does not call it": ("self.tick)", "lambda: self.tick)"),
    "self.move(1) is called at once": ("PERIOD, self.tick)",
     "PERIOD, self.move(1))\n\n    def move(self, x):\n        self.x = x"),
    "self.publisher.publish(Twist()) is called at once": ("self.tick)", "self.publisher.publish(Twist()))"),
    "'tick' is given where the callback is needed": ("self.tick)", "'tick')"),
    "makes a coroutine that nobody awaits": ("        best = 9.0",
     "        best = 9.0\n        self.wait()\n\n    async def wait(self):\n        pass\n"),
    # waiting.py
    "the sleep() of a Rate": ("    rclpy.spin(node)", "    rate = node.create_rate(10)\n    while rclpy.ok():\n     "
                                                      "   rate.sleep()"),
    "rate.sleep() waits for a timer": ("        now = self",
     "        rate = self.create_rate(10)\n        rate.sleep()\n        now = self"),
    "this loop in main() runs before": ("    rclpy.spin(node)",
     "    while True:\n        node.tick()\n    rclpy.spin(node)"),
    "this loop in __init__ runs before": (
        "        self.done = False",
        "        while self.publisher.get_subscription_count() == 0:\n            pass\n        self.done = False",
    ),
    "but no node is in it": ("    rclpy.spin(node)", "    e = SingleThreadedExecutor()\n    e.spin()"),
    "this spins a plain node": ("rclpy.spin(node)", "rclpy.spin(Node('teleop'))"),
    "this makes a second Teleop": ("rclpy.spin(node)", "rclpy.spin(Teleop())"),
    "after this line has ended it": ("    rclpy.spin(node)", "    rclpy.shutdown()\n    rclpy.spin(node)"),
    # names.py
    "so write self.done = ...": ("            self.done = True", "            done = True"),
    "hides the method tick": ("self.start = None", "self.tick = 0"),
    "this def tick replaces that in line": ("    def smallest(",
     "    def tick(self):\n        pass\n\n    def smallest("),
    "is a variable of the class": ("            self.done = True", "            Teleop.done = True"),
    "start = ... makes a variable of tick alone": ("            self.start = now",
     "            start = now\n            print(start)"),
    "done = ... makes a variable of tick alone": (
        "            self.done = True", "            done = True\n            print(done)",
    ),
    # not_what_they_seem.py
    "can be gone through once only, which line": (
        "        best = 9.0", "        valid = (r for r in ranges if r > 0)\n        print(len(list(valid)))\n      "
                              "  best = min(valid)"
    ),
    "command.linear is self.other.linear itself since line": (
        "            command.linear.x = 0.5", "            command.linear = self.other.linear\n            "
                                              "command.linear.x = 0.5"
    ),
    "is asks whether both are the same object": ("elapsed < SECONDS", "self.side is 'left'"),
    "repeats one and the same row": ("        best = 9.0", "        grid = [[0] * 3] * 4\n        best = grid[0][0]"),
    "has the whole seconds only": ("        best = 9.0", "        best = Time(seconds=self.stamp.sec)"),
    "of Python's logging shows nothing here": ("import rclpy\n",
     "import logging\nlogging.getLogger('a').info('b')\nimport rclpy\n"),
    # angles.py
    "sin() takes radians, not degrees": ("        best = 9.0", "        best = math.sin(90)"),
    "angle_min of a LaserScan is in radians already": ("        best = 9.0",
     "        best = math.radians(ranges.angle_min)"),
    "atan2 takes y first and x second": ("        best = 9.0",
     "        best = math.atan2(goal.x - self.x, goal.y - self.y)"),
    "is no angle: z of a quaternion": ("        best = 9.0",
     "        yaw = message.pose.orientation.z\n        best = yaw"),
    # no_effect.py
    "compares and throws the result away": ("self.done = True", "self.done == True"),
    "is computed and thrown away": ("self.done = True", "self.done + 1"),
    "do_transform_point() does not change what it is given": ("self.done = True", "do_transform_point(hit, t)"),
    "np.clip(ranges, 0, 1) is thrown away": ("        best = 9.0", "        best = 9.0\n        np.clip(ranges, 0, 1)"),
    "self.done =+ 1 sets it to 1": ("self.done = True", "self.done =+ 1"),
    "is set after publish(command)": ("self.publisher.publish(command)",
     "self.publisher.publish(command)\n        command.linear.x = 0.0"),
    "command.linear.x is set after publish": ("self.publisher.publish(command)",
     "self.publisher.publish(command)\n        if self.done:\n            command.linear.x = 0.0"),
    "stop, a Twist, is made here and never used": ("            self.done = True",
     "            stop = Twist()\n            stop.linear.x = 0.0"),
    "is always true, because 'turn' is": ("elapsed < SECONDS", "self.state == 'go' or 'turn'"),
    "rclpy.ok without brackets": ("elapsed < SECONDS", "rclpy.ok"),
    "which ends in its first iteration": ("        return best", "            return best"),
    "takes the name away, and the timer goes on": ("self.done = True", "self.timer = None"),
    "starts the period again": ("self.done = True", "self.timer.reset()"),
}  # fmt: skip


def test_a_right_file_has_none():
    assert slips(RIGHT.encode(), 8.0) == []


@pytest.mark.parametrize("words", WRONG)
def test_each_is_named_with_its_line(words):
    old, new = WRONG[words]
    assert old in RIGHT
    found = slips(RIGHT.replace(old, new).encode(), 8.0)
    assert [place for place in found if words in place["said"] and place["line"] > 1], found


HARMLESS = [
    ("elapsed = (now - self.start).nanoseconds / 1e9", "elapsed = (now - self.start).nanoseconds * 1e-6 / 1000"),
    ("elapsed < SECONDS", "elapsed * 1000 < 5000"),
    ("elapsed < SECONDS", "(now - self.start).nanoseconds < 5 * 10**9"),
    ("elapsed < SECONDS", "now - self.start < Duration(seconds=5)"),
    ("elapsed < SECONDS", "elapsed > 0 and elapsed < SECONDS"),
    ("elapsed = (now - self.start)", "elapsed = abs(self.start - now)"),
    ("self.start).nanoseconds / 1e9\n", "Time.from_msg(msg.header.stamp)).nanoseconds / 1e9 - 1e7\n        old = "
                                        "abs(elapsed) > 1e10\n"),
    ("self.tick)", "lambda: self.tick())"),
    ("self.tick)", "self.later(1))"),
    ("    rclpy.spin(node)", "    while rclpy.ok():\n        rclpy.spin_once(node)"),
    ("    rclpy.spin(node)", "    threading.Thread(target=rclpy.spin, args=(node,)).start()\n    rate = "
                             "node.create_rate(1)\n"
     "    while rclpy.ok():\n        rate.sleep()"),
    ("    rclpy.spin(node)", "    e = SingleThreadedExecutor()\n    e.add_node(node)\n    e.spin()"),
    ("        return best", "            if best < 1.0:\n                return best\n        return best"),
    ("            self.done = True", "            done = True\n            self.done = done"),
    ("            self.done = True", "            stop = Twist()\n            command = stop\n            self.done "
                                     "= True"),
    ("self.publisher.publish(command)", "self.publisher.publish(command)\n        command = Twist()\n        "
                                        "command.linear.x = 1.0\n"
     "        self.publisher.publish(command)"),
    ("        best = 9.0", "        valid = [r for r in ranges]\n        best = max(valid) + min(valid)"),
    ("        best = 9.0", "        valid = (r for r in ranges)\n        best = max(valid)"),
    ("        best = 9.0", "        best = t.sec + t.nanosec * 1e-9 + t.sec * 10**9 + t.nanosec"),
    ("        best = 9.0", "        best = t.sec * 1000 + t.nanosec / 1e6 - int(t.sec * 1e9 + t.nanosec)"),
    ("        best = 9.0", "        best = 9.0\n        np.clip(ranges, 0, 1, out=ranges)\n        ranges.sort()"),
    ("elapsed < SECONDS", "self.done is True or self.start is None"),
    ("        best = 9.0", "        best = math.sin(math.radians(90)) + math.atan2(p.y, p.x) + math.cos(6)"),
    ("self.done = True", "self.timer.cancel()\n            self.timer = None"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new"), HARMLESS)
def test_what_works_is_not_named(old, new):
    assert old in RIGHT
    assert slips(RIGHT.replace(old, new).encode(), 8.0) == []


@pytest.mark.parametrize(
    "after",
    [
        "if self.done:\n            self.publisher.publish(command)\n            command.linear.x = 0.0\n"
        "        self.publisher.publish(command)",
        "for _ in range(3):\n            self.publisher.publish(command)\n            command.linear.x = 0.0",
    ],
)
def test_a_message_that_is_changed_and_published_again(after):
    text = RIGHT.replace("self.publisher.publish(command)", after)
    assert text != RIGHT and slips(text.encode()) == []
