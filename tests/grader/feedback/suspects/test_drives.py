"""Drives for some seconds that never end, end by the place or begin again: the place in the file is found."""

import pytest

from gz_course.grader.feedback.suspects import suspects

HEAD = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.out = self.create_publisher(Twist, "/cmd_vel", 10)
        self.first = None
        self.create_timer(0.1, self.tick)

"""
RIGHT = (
    HEAD
    + """\
    def tick(self):
        now = self.get_clock().now()
        if self.first is None:
            self.first = now
        passed = (now - self.first).nanoseconds / 1e9
        command = Twist()
        if passed < 5.0:
            command.linear.x = 0.5
        self.out.publish(command)
"""
)
PLACE = """\
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)
        self.way = 0.0

    def on_odometry(self, odometry):
        self.way = odometry.pose.pose.position.x
"""
WRONG = {
    "self.passed is computed only here": (
        "endless",
        ("self.first = now\n", "self.first = now\n            self.passed = now - self.first\n"),
        ("passed < 5.0", "self.passed < Duration(seconds=5)"),
    ),
    "self.command is one message for all calls": (
        "endless",
        ("self.first = None\n", "self.first = None\n        self.command = Twist()\n"),
        ("        command = Twist()\n", ""),
        ("command.linear.x", "self.command.linear.x"),
        ("publish(command)", "publish(self.command)"),
    ),
    "command=Twist() is made once": (
        "endless", ("tick(self)", "tick(self, command=Twist())"), ("        command = Twist()\n", ""),
    ),
    "comes after the condition of line 14": (
        "endless", ("            command.linear.x", "            pass\n        command.linear.x"),
    ),
    "go is one message for all calls": (
        "endless", ("class Driver", "go = Twist()\n\n\nclass Driver"), ("        command = Twist()\n", ""),
        ("command.linear.x", "go.linear.x"), ("publish(command)", "publish(go)"),
    ),
    "sets the start again in every call of on_odometry": (
        "endless", ("        self.create_timer", PLACE + "        self.create_timer"),
        ("odometry.pose.pose.position.x", "odometry.header.stamp.sec"), ("now - self.first", "now - self.way"),
    ),
    "int(passed) == 5 holds for a moment": ("again", ("passed < 5.0", "not int(passed) == 5")),
    "compares a time in seconds with 50": ("endless", ("passed < 5.0", "passed < 50")),
    "nothing in the file asks how much time has passed": (
        "endless",
        (RIGHT[RIGHT.index("        now =") :], "        self.go.linear.x = 0.5\n        self.out.publish(self.go)\n"),
    ),
    "self.done = True changes nothing: nothing reads self.done": (
        "endless", ("        if passed", "        if passed > 5:\n            self.done = True\n        if passed"),
    ),
    "except TypeError: hides the errors of lines 13 to 13": (
        "hidden",
        (
            "        passed = (now - self.first).nanoseconds / 1e9\n",
            "        try:\n            passed = now - self.first\n        except TypeError:\n            passed = 0\n",
        ),
    ),
    "self.way >= 2.5 asks for the place (pose.position.x)": (
        "by_place", ("        self.create_timer", PLACE + "        self.create_timer"),
        ("passed < 5.0", "not self.way >= 2.5"), ("        passed = (now - self.first).nanoseconds / 1e9\n", ""),
    ),
    "self.first = None makes the next call take itself for the first one": (
        "again", ("        self.out.publish", "        else:\n            self.first = None\n        self.out.publish"),
    ),
    "self.first = now stands below  if self.first is None or now - self.first > limit:": (
        "again", ("if self.first is None:", "if self.first is None or now - self.first > limit:"),
    ),
    "then the same call goes on to line 18": (
        "again",
        ("        command = ", "        if passed > 5:\n            self.out.publish(Twist())\n        command = "),
    ),
}  # fmt: skip


def changed(*changes: tuple[str, str]) -> bytes:
    text = RIGHT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return text.encode()


def test_a_right_drive_has_none():
    assert suspects(RIGHT.encode()) == []


@pytest.mark.parametrize("words", WRONG)
def test_the_place_of_a_wrong_drive_is_found(words):
    about, *changes = WRONG[words]
    found = suspects(changed(*changes))
    assert any(each["about"] == about and words in each["said"] for each in found), found


def test_a_patrol_that_sets_its_goal_to_none_is_none():
    patrol = changed(
        ("        self.first = None\n", "        self.first = None\n        ActionServer(self, Go, 'go', self.run)\n"),
        ("        self.out.publish", "        else:\n            self.first = None\n        self.out.publish"),
    )
    assert "again" not in {each["about"] for each in suspects(patrol)}
