"""How an action server takes goals, and places that are copied before a loop or kept from the first message."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Server(Node):
    def __init__(self):
        self.x = self.y = 0.0
        self.place = None
        self.route = []
        self.index = 0

    def on_odometry(self, message):
        self.x, self.y = message.pose.pose.position.x, message.pose.pose.position.y
        if self.place is None:
            self.log("first")
        self.place = message.pose.pose

    def on_goal(self, goal):
        if not goal.waypoints or not 0 < goal.speed <= self.fastest or len(goal.waypoints) < 1:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def execute(self, handle):
        self.route = []
        self.index = 0
        x0, y0 = self.x, self.y
        self.route.extend(handle.request.waypoints)
        while self.index < len(self.route):
            x, y = self.x, self.y
            left = hypot(self.route[self.index].x - x, self.route[self.index].y - y)
            if handle.is_cancel_requested:
                handle.canceled()
                return Patrol.Result()
            self.publisher.publish(self.command(left, x0, y0))
            self.index += left < 0.1
        handle.succeed()
        return Patrol.Result()
"""
LOG = '            self.log("first")\n        self.place'
KEEP = "            self.place"


def said(source, about):
    return " ".join(each["said"] for each in suspects(source.encode()) if each["about"] == about)


def test_a_right_server_has_none():
    assert suspects(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("len(goal.waypoints) < 1", "len(goal.waypoints) < 2", "goal_length", "a goal with one is a goal, too"),
        ("<= self.fastest", "< self.fastest", "goal_limit", "max_speed itself is refused"),
        ("not 0 < goal.speed <= self.fastest", "goal.speed >= self.fastest", "goal_limit", "only one above it"),
        ("handle.canceled()", "handle.abort()", "cancel", "handle.canceled() belongs here"),
        ("        self.route = []\n        self.index = 0\n        x0", "        x0", "anew", "self.route keeps what"),
        ("        self.index = 0\n        x0", "        x0", "anew", "self.index is 0 for the first goal only"),
        (LOG, KEEP, "first_kept", "keeps its first message"),
        ("x0, y0", "px, py", "old_pose", "px, py are copies of self.x, self.y"),
        ("hypot(self.route[self.index].x - x, self.route[self.index].y - y)", "1", "old_pose", ""),
    ],
)  # fmt: skip
def test_each_is_found(old, new, about, words):
    assert old in RIGHT
    assert words in said(RIGHT.replace(old, new), about)


def test_a_place_handed_over_to_the_loop_is_a_copy():
    helper = """
    def drive(self, x, y):
        while hypot(x, y) > 0.1:
            self.publisher.publish(Twist())

    def begin(self):
        self.drive(self.x, self.y)
"""
    assert "made before the loop" in said(RIGHT + helper, "old_pose")


@pytest.mark.parametrize(
    ("test", "found"),
    [
        ("while abs(p.x - self.x) > NEAR and abs(p.y - self.y) > NEAR:", True),
        ("while abs(p.x - self.x) > NEAR or abs(p.y - self.y) > NEAR:", False),
        ("if abs(p.x - self.x) < NEAR or abs(p.y - self.y) < NEAR:", True),
        ("if abs(p.x - self.x) < NEAR and abs(p.y - self.y) < NEAR:", False),
    ],
)
def test_a_place_that_is_reached_by_one_axis(test, found):
    source = f"def go(self, p):\n    {test}\n        self.publisher.publish(Twist())\n"
    assert bool(said(source, "one_axis")) == found


def test_an_angle_in_degrees_beside_one_in_radians():
    heading = "self.heading = degrees(2 * atan2(q.z, q.w))\nturn = atan2(dy, dx) - self.heading\n"
    assert "self.heading is in degrees, and atan2(dy, dx) in radians" in said(heading, "angle")
    assert said(heading.replace("degrees(2 * atan2(q.z, q.w))", "2 * atan2(q.z, q.w)"), "angle") == ""
    assert said(heading.replace("atan2(dy, dx) -", "degrees(atan2(dy, dx)) -"), "angle") == ""


def test_a_heading_that_is_returned_in_degrees():
    source = (
        "def yaw(q):\n    return math.degrees(2 * math.atan2(q.z, q.w))\n\n"
        "def turn(self, p):\n    return math.atan2(p.y - self.y, p.x - self.x) - self.heading\n"
    )
    assert "is a heading in degrees" in said(source, "angle")
    assert said(source.replace("self.heading", "math.radians(self.heading)"), "angle") == ""
    assert said(source.replace("math.degrees", ""), "angle") == ""


@pytest.mark.parametrize(
    ("source", "about", "words"),
    [
        ("if turn < 0.3:\n    command.linear.x = speed\n", "one_side", "compare abs(turn)"),
        ("if abs(turn) < 0.3:\n    command.linear.x = speed\n", "one_side", ""),
        ("if left < 0.3:\n    command.linear.x = speed\n", "one_side", ""),
        ("self.x += m.twist.twist.linear.x * 0.05\n", "summed_place", "a sum of velocities"),
        ("self.x += step\n", "summed_place", ""),
        ("f = Patrol.Feedback(distance=round(left))\n", "feedback", "is a whole number"),
        ("f = Patrol.Feedback(distance=round(left, 2))\n", "feedback", ""),
    ],
)
def test_angles_places_and_distances(source, about, words):
    found = said(source, about)
    assert words in found and bool(words) == bool(found)
