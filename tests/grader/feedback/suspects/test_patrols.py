"""Loops of an action server that do not ask for a cancellation, and counts that go on from goal to goal."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
class Server(Node):
    def __init__(self):
        self.goals = 0
        self.last = Patrol.Result()

    def execute(self, handle):
        self.visited = 0
        self.goals += 1
        result = Patrol.Result()
        for waypoint in handle.request.waypoints:
            while self.left(waypoint) > 0.1:
                if handle.is_cancel_requested:
                    return self.stopped(handle, result)
                self.publisher.publish(self.command(waypoint))
                time.sleep(0.1)
            result.visited += 1
            self.visited += 1
        for _ in range(3):
            self.places.append(0)
        result.visited = self.visited
        handle.succeed()
        return result
"""
ASKS = """\
                if handle.is_cancel_requested:
                    return self.stopped(handle, result)
"""
LOOP = "            while self.left(waypoint) > 0.1:\n"


def said(source, about):
    return [each["said"] for each in suspects(source.encode()) if each["about"] == about]


def test_a_right_server_has_none():
    assert suspects(RIGHT.encode()) == []


def test_a_loop_that_asks_by_a_method_or_in_its_condition_asks():
    method = "\n    def gone(self, handle):\n        return handle.is_cancel_requested\n"
    assert said(RIGHT.replace("if handle.is_cancel_requested", "if self.gone(handle)") + method, "cancel") == []
    condition = RIGHT.replace(ASKS, "").replace("> 0.1:", "> 0.1 and not handle.is_cancel_requested:")
    assert said(condition, "cancel") == []
    assert said(RIGHT.replace(ASKS, ""), "cancel") == [], "nothing asks: the recording has to say it"


def test_a_loop_that_does_not_ask():
    outside = "            if handle.is_cancel_requested:\n                return result\n"
    before = RIGHT.replace(ASKS, "").replace(LOOP, outside + LOOP)
    (words,) = said(before, "cancel")
    assert "line 11 asks it once for each waypoint" in words
    turns = "            while self.off(waypoint) > 0.1:\n                self.publisher.publish(self.turn(waypoint))\n"
    (words,) = said(RIGHT.replace(LOOP, turns + LOOP), "cancel")
    assert "the loop that drives does not ask" in words


def test_a_break_that_leaves_the_inner_loop_only():
    broken = RIGHT.replace("    return self.stopped(handle, result)", "    break")
    (words,) = said(broken, "cancel")
    assert "leaves the inner loop only, and the loop in line 10 goes on" in words
    again = "            if handle.is_cancel_requested:\n                break\n            result.visited += 1\n"
    assert said(broken.replace("            result.visited += 1\n", again), "cancel") == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("result.visited += 1", "self.last.visited += 1", "self.last is made once for all goals"),
        (
            "        self.visited = 0\n        self.goals += 1\n",
            "",
            "self.visited is set once for all goals",
        ),
    ],
)
def test_a_count_that_goes_on(old, new, words):
    source = RIGHT.replace(old, new, 1)
    if not new:
        source = source.replace("self.goals = 0", "self.visited = 0")
    (found,) = said(source, "result")
    assert words in found


def test_a_cancellation_that_counts_under_a_condition():
    asked = RIGHT.replace("if handle.is_cancel_requested", "if self.goals == 1 and handle.is_cancel_requested")
    assert said(asked, "cancel") == ["a cancellation counts only if `self.goals == 1` is true, too"]


def test_a_loop_that_brakes_does_not_ask_again():
    loop = "while self.speed > 0:\n                        self.publisher.publish(self.slower())\n"
    braking = RIGHT.replace(
        "if handle.is_cancel_requested:\n", f"if handle.is_cancel_requested:\n                    {loop}"
    )
    assert not said(braking, "cancel")
