"""Objects and attributes of classes that two subscriptions share."""

import pytest

from gz_course.grader.feedback.slips import slips

RIGHT = """\
class Robot:
    def __init__(self):
        self.pose = None

    def update(self, message):
        self.pose = message.pose.pose


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.own = Robot()
        self.front = Robot()
        self.create_subscription(Odometry, "odom", self.own.update, 10)
        self.create_subscription(Odometry, "front/odom", self.front.update, 10)
        self.create_timer(0.1, self.steer)

    def steer(self):
        print(self.own.pose, self.front.pose)


rclpy.spin(Follower())
"""


def said(text):
    return [each["said"] for each in slips(text.encode())]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("self.front = Robot()", "self.front = self.own", "self.front is self.own here, one object with two names"),
        ("self.own = Robot()\n        self.front = Robot()", "self.own = self.front = Robot()", "are one object with"),
        ("self.pose = message", "Robot.pose = message", "all 2 objects of Robot share it"),
    ],
)
def test_what_two_subscriptions_share(old, new, words):
    assert said(RIGHT) == []
    assert any(words in each for each in said(RIGHT.replace(old, new)))


def test_what_may_be_shared():
    assert said(RIGHT.replace("self.pose = message", "Robot.count = 1\n        self.pose = message")) == []
    once = RIGHT.replace("self.front = Robot()", "self.front = Other()").replace("self.pose = m", "Robot.pose = m")
    assert not any("share" in each for each in said(once))


KEPT = """
class Planner:
    def __init__(self, grid):
        self.grid = grid
class Mapper:
    def __init__(self):
        self.grid = Grid(100, 80)
        self.planner = Planner(self.grid)
        {}
"""


@pytest.mark.parametrize(
    ("line", "number"),
    [("self.grid = Grid(100, 80)", 1), ("self.grid = Grid(); self.planner = Planner(self.grid)", 0), ("pass", 0)],
)
def test_what_is_replaced_after_it_was_handed_over(line, number):
    said = [each["said"] for each in slips(KEPT.format(line).encode())]
    assert sum("keeps that" in each for each in said) == number


def test_a_second_map_that_is_handed_over():
    text = KEPT.format("pass").replace("Planner(self.grid)", "Planner(Grid(100, 80))")
    said = [each["said"] for each in slips(text.encode())]
    assert any("is a second one here, beside self.grid" in each for each in said)


LAUNCH = """\
BASE = ["python3", "follower.py"]
BASE += ["--ros-args"]
def follower(number):
    command = BASE
    command += ["-r", f"__ns:=/robot{number}"]
    return ExecuteProcess(cmd=command)
def convoy(context):
    return [follower(number) for number in range(2, 5)]
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("", "", True),
        ("command += [", "command.extend([", True),
        ("command = BASE", "command = [*BASE]", False),
        ("command = BASE", "command = BASE + []", False),
        ("command += [", "command = command + [", False),
        ("[follower(number) for number in range(2, 5)]", "[follower(2)]", False),
    ],
)
def test_a_list_that_grows_from_call_to_call(old, new, found):
    source = LAUNCH.replace(old, new)
    source = source.replace('robot{number}"]', 'robot{number}"])') if "extend(" in new else source
    said = [each["said"] for each in slips(source.encode())]
    assert any("command is BASE itself (line 4), not a copy" in each for each in said) is found


HEADER = """\
def on_picture(self, colour):
    for hit in self.hits(colour):
        message = PointStamped()
        message.header = {source}.header
        message.header.frame_id = "camera_link"
        self.publisher.publish(message)
{after}
"""


@pytest.mark.parametrize(
    ("source", "after", "found"),
    [
        ("colour", "", False),
        ("colour", "    self.stamps.append(colour.header)", True),
        ("colour", "    print(colour)", True),
        ("self.scan", "", True),
    ],
)
def test_a_header_that_is_changed_where_it_is_shared(source, after, found):
    words = said(HEADER.format(source=source, after=after))
    assert any("itself since line 4" in each for each in words) == found
