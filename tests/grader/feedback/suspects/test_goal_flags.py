"""What an action server keeps from goal to goal, and loops over waypoints that leave one out."""

import pytest

from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Server(Node):
    def __init__(self):
        self.busy = False
        self.cancelled = False
        self.done = Event()
        self.server = ActionServer(self, Patrol, "patrol", self.execute, cancel_callback=self.on_cancel)

    def on_goal(self, goal):
        if self.busy:
            return GoalResponse.REJECT
        if not goal.waypoints or not 0.0 < goal.speed <= self.get_parameter("max_speed").value:
            return GoalResponse.REJECT
        self.busy = True
        self.points = goal.waypoints
        return GoalResponse.ACCEPT

    def on_cancel(self, handle):
        return CancelResponse.ACCEPT

    def execute(self, handle):
        self.done.clear()
        self.cancelled = False
        while self.place is None:
            self.get_logger().info("no place")
            time.sleep(0.1)
        index = 0
        waypoints = handle.request.waypoints
        while index < len(waypoints):
            if handle.is_cancel_requested or self.cancelled:
                handle.canceled()
                return Patrol.Result()
            handle.publish_feedback(self.feedback(waypoints[index]))
            self.go(self.points[index])
            index += 1
        for waypoint in waypoints:
            self.say(waypoint)
        self.done.wait()
        self.busy = False
        handle.succeed()
        return Patrol.Result()

    def arrive(self):
        self.done.set()
"""
EARLY = "    def on_goal(self, goal):\n"
CANCEL = "        return CancelResponse.ACCEPT"
BUSY = "        self.busy = False\n        handle.succeed()"


def said(source, about):
    return " ".join(each["said"] for each in suspects(source.encode()) if each["about"] == about)


def test_a_right_server_has_none():
    assert suspects(RIGHT.encode()) == []


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("        if not goal", "        self.busy = True\n        if not goal", "refuses_all", "rejected goal leaves"),
        (EARLY, f"{EARLY}        self.points = goal.waypoints\n", "stored_goal", "also by one that line 13 rejects"),
        ("        self.done.clear()\n", "", "anew", "self.done.clear() where a goal is executed"),
        ("handle.is_cancel_requested or self.cancelled", "not handle.is_active", "cancel", "stays True until"),
        ("handle.succeed()", "handle.abort()", "ended", "handle.succeed() ends one that was done"),
        ("handle.publish_feedback(", "(", "no_feedback", "never calls publish_feedback()"),
        ("index = 0", "index = 1", "left_out", "leaves out the first waypoint"),
        ("index < len(waypoints)", "index < len(waypoints) - 1", "left_out", "leaves out the last waypoint"),
        ("for waypoint in waypoints:", "for waypoint in waypoints[1:]:", "left_out", "out the first waypoint"),
        ("for waypoint in waypoints:", "for waypoint in waypoints[:-1]:", "left_out", "out the last waypoint"),
        ("for waypoint in waypoints:", "for i in range(len(waypoints) - 1):", "left_out", "out the last waypoint"),
        (
            "            self.say(waypoint)",
            "            self.say(waypoint)\n            return 1",
            "left_early",
            "return",
        ),
        ("self.feedback(waypoints[index])", "F(waypoint=index / 1)", "feedback", "the field waypoint is an int32"),
    ],
)
def test_each_is_found(old, new, about, words):
    assert old in RIGHT
    assert words in said(RIGHT.replace(old, new, 1), about)


def test_a_flag_of_cancellations_that_nothing_sets_back():
    sets = RIGHT.replace(CANCEL, f"        self.cancelled = True\n{CANCEL}", 1)
    assert said(sets, "anew") == ""
    execute = "        self.done.clear()\n        self.cancelled = False\n"
    assert "so every later goal counts as cancelled" in said(
        sets.replace(execute, "        self.done.clear()\n"), "anew"
    )


def test_a_list_that_is_changed_and_a_return_elsewhere_in_the_loop():
    loop = (
        "def go(points):\n    for p in points:\n        if p is None:\n            return\n        points.remove(p)\n"
    )
    assert "skips the next element" in slips(loop.encode())[0]["said"]
    assert slips((loop + "        break\n").encode()) == []
