"""What a server accepts, whether it listens to its own functions, and phases of a drive that stay over."""

import pytest

from gz_course.grader.feedback.suspects import suspects

SERVER = """\
class Server(Node):
    def __init__(self):
        self.declare_parameter("max_speed", 0.5)
        self.server = ActionServer(self, Patrol, "patrol", self.execute, goal_callback=self.on_goal)

    def on_odometry(self, message):
        self.x = message.pose.pose.position.x
        self.speed = message.twist.twist.linear.x

    def on_goal(self, goal):
        limit = self.get_parameter("max_speed").value
        if len(goal.waypoints) == 0:
            return GoalResponse.REJECT
        if goal.speed <= 0 or goal.speed > limit:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def drive_to(self, handle, point):
        while math.hypot(point.x - self.x, point.y) > 0.1:
            if handle.is_cancel_requested:
                return False
            self.step(point)
            handle.publish_feedback(Patrol.Feedback())
        return True

    def execute(self, handle):
        for point in handle.request.waypoints:
            if not self.drive_to(handle, point):
                handle.canceled()
                return Patrol.Result()
        handle.succeed()
        return Patrol.Result()
"""
TURNS = """\
def execute(handle):
    phase = "turn"
    for point in handle.request.waypoints:
        while far(point):
            if phase == "turn":
                command.angular.z = angle(point)
                if abs(angle(point)) < 0.1:
                    phase = "drive"
            else:
                command.linear.x = 0.3
"""


def said(source, about):
    return " ".join(each["said"] for each in suspects(source.encode()) if each["about"] == about)


def test_a_right_server_has_none():
    assert suspects(SERVER.encode()) == []


@pytest.mark.parametrize(
    ("about", "old", "new", "words"),
    [
        ("accepts_empty", "len(goal.waypoints) == 0", "goal.waypoints is None", "has an empty list"),
        ("accepts_backwards", "goal.speed <= 0", "abs(goal.speed) == 0", "has no sign any more"),
        ("other_limit", '"max_speed", 0.5', '"max_velocity", 0.5', "the task calls the limit `max_speed`"),
        ("other_limit", "goal.speed > limit", "goal.speed > 0.5", "takes the constant 0.5 for the limit"),
        (
            "other_limit", 'limit = self.get_parameter("max_speed").value', "limit = 0.5",
            "takes the constant 0.5 for the limit",
        ),
        ("refuses_all", "goal.speed > limit", "goal.speed < limit", "is True for a goal with two waypoints"),
        ("refuses_all", "len(goal.waypoints) == 0", "len(goal.waypoints) > 1", "so on_goal rejects it"),
        ("accepts_standing", "goal.speed <= 0", "goal.speed < 0", "is False for a speed of 0, so on_goal accepts it"),
        ("accepts_backwards", "goal.speed <= 0 or", "goal.speed <= 0 and", "is False for a speed of -0.2 m/s"),
        ("accepts_empty", "== 0:", "== -1:", "is False for a goal without waypoints"),
        ("accepts_all", "GoalResponse.REJECT", "GoalResponse.ACCEPT", "knows no answer but"),
        (
            "cancel", "            if not self.drive_to(handle, point):\n                handle.canceled()\n"
            "                return Patrol.Result()\n", "            self.drive_to(handle, point)\n",
            "returns False when the goal is to be cancelled",
        ),
        (
            "refuses_all", "        if len(goal", "        if not self.lock.acquire(blocking=False):\n"
            "            return GoalResponse.REJECT\n        if len(goal", "nothing releases it then",
        ),
        ("no_place", "pose.pose.position.x", "twist.twist.linear.x", "is a velocity of the robot"),
    ],
)  # fmt: skip
def test_a_wrong_server_is_named(about, old, new, words):
    assert old in SERVER
    assert words in said(SERVER.replace(old, new), about)


def test_a_phase_that_nothing_begins_again_is_named():
    assert "nothing sets it back to 'turn'" in said(TURNS, "phase")
    flag = TURNS.replace('phase = "turn"', "phase = False").replace('phase = "drive"', "phase = True")
    assert "nothing sets it back to False" in said(flag.replace('phase == "turn"', "not phase"), "phase")


def test_a_phase_that_begins_with_each_waypoint_is_right():
    inside = TURNS.replace("        while far", '        phase = "turn"\n        while far')
    assert said(inside, "phase") == ""


@pytest.mark.parametrize(
    ("condition", "found"), [("abs(turn) > 5", True), ("abs(turn) > 0.1", False), ("left > 5", False)]
)
def test_a_limit_of_an_angle_in_degrees_is_named(condition, found):
    source = f"def step(self):\n    turn = atan2(dy, dx) - self.heading\n    if {condition}:\n        stop()\n"
    assert ("5 degrees are 0.087" in said(source, "angle")) == found
