"""Suspects in planning: each is found in a file that is right but for it."""

import pytest

from gz_course.grader.feedback.suspects import suspects

RIGHT = """\
def middle(cell):
    return -5 + (cell[0] + 0.5) * 0.1, -4 + (cell[1] + 0.5) * 0.1


from collections import deque
from math import atan2, pi, remainder

import numpy as np


class Robot:
    def __init__(self):
        self.way = []
        self.x = None
        self.counts = np.zeros((80, 100), dtype=int)

    def on_odom(self, message):
        self.x = message.pose.pose.position.x
        self.y = message.pose.pose.position.y

    def plan(self):
        start = self.cell()
        before, queue = {start: None}, deque([start])
        while queue:
            cell = queue.popleft()
            if cell in self.goals:
                break
            for beside in neighbours(cell):
                if beside not in before:
                    before[beside] = cell
                    queue.append(beside)
        way = []
        while cell is not None:
            way.append(cell)
            cell = before[cell]
        return way[::-1]

    def drive(self):
        if not self.way:
            self.way = self.plan()
        x, y = middle(self.way[0])
        goal = atan2(y - self.y, x - self.x)
        error = remainder(goal - self.heading, 2 * pi)
        command.angular.z = max(-1.0, min(1.0, 2 * error))
        if self.near(x, y):
            self.way.pop(0)

    def on_scan(self, rows, columns):
        self.counts[rows, columns] += 1
"""


def test_a_right_file_has_none():
    assert suspects(RIGHT.encode()) == []


SIGN = "remainder(self.heading - goal, 2 * pi)"


@pytest.mark.parametrize(
    ("old", "new", "about", "words"),
    [
        ("queue.popleft()", "queue.pop()", "search", "takes the newest cell"),
        ("way[::-1]", "way", "way", "nothing turns it round"),
        ("            self.way.pop(0)", "            pass", "way", "the robot goes for the same cell for ever"),
        ("if not self.way:", "if len(self.way) == 0:", "", ""),
        ("dtype=int", "dtype=np.int8", "counter", "begin again at the other end"),
        ("dtype=int", "dtype='uint8'", "counter", "begin again at the other end"),
        ("remainder(goal - self.heading, 2 * pi)", SIGN, "sign", "the error with the wrong sign"),
        ("middle(self.way[0])", "self.way[0]", "cell", "subtracts metres from"),
        (
            "    def on_odom(self, message):\n",
            "    def on_odom(self, message):\n        if self.x is not None:\n            return\n",
            "pose",
            "the pose is that of the first message for ever",
        ),
        ("atan2(y - self.y, x - self.x)", "atan2(y, x)", "cell", "from the origin of the map, not from the robot"),
        (
            "        self.counts[rows",
            "        for r in scan.ranges[:180]:\n            pass\n        self.counts[rows",
            "part",
            "scan.ranges[:180] leaves out a part of the rays",
        ),
        ("remainder(goal - self.heading, 2 * pi)", "goal - self.heading", "wrap", "the long way round"),
    ],
)
def test_each_is_found(old, new, about, words):
    text = RIGHT.replace(old, new)
    text = text.replace("remainder(", "wrapped(") if about == "wrap" else text
    found = [place for place in suspects(text.encode()) if place["about"] == about]
    assert text != RIGHT and bool(found) == bool(about)
    assert not found or words in found[0]["said"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("dtype=int", "dtype=np.int8"),
        ("remainder(goal - self.heading, 2 * pi)", SIGN),
        ("queue.popleft()", "queue.pop()"),
        ("return way[::-1]", "way.reverse()\n        return way"),
        ("self.way.pop(0)", "self.way = self.way[1:]"),
        ("    def on_odom(self, message):\n",
         "    def on_odom(self, message):\n        if self.paused is None:\n            return\n"),
    ],
)  # fmt: skip
def test_what_is_right_all_the_same(old, new):
    text = RIGHT.replace(old, new)
    text = text.replace("[rows, columns] += 1", "[rows, columns] = 1")  # a mark, not a count
    text = text.replace("2 * error", "-2 * error") if new == SIGN else text
    text = text.replace("before[beside] = cell", "before.add(beside)")  # a flood, not a way
    assert text != RIGHT and suspects(text.encode()) == []


def test_a_way_that_another_method_plans_once():
    planned = RIGHT.replace("self.way = self.plan()", "self.plan()").replace("return way[::-1]", "self.way = way[::-1]")
    assert suspects(planned.encode()) == []
    once = planned.replace("            self.way.pop(0)", "            pass")
    assert [each["about"] for each in suspects(once.encode())] == ["way"]
    again = once.replace("        self.counts[rows", "        self.plan()\n        self.counts[rows")
    assert not any("planned only while it is empty" in each["said"] for each in suspects(again.encode()))


@pytest.mark.parametrize(
    ("cell", "words"), [("0", "in which the robot stands already"), ("-1", "steers straight to it"), ("3", "")]
)
def test_only_one_end_of_a_way(cell, words):
    planned = RIGHT.replace("self.way = self.plan()", "self.plan()").replace("return way[::-1]", "self.way = way[::-1]")
    text = planned.replace("if not self.way:", "if True:").replace("            self.way.pop(0)", "            pass")
    found = [each["said"] for each in suspects(text.replace("self.way[0]", f"self.way[{cell}]").encode())]
    assert words in found[0] if words else found == []


SIDES = "2.0 if error > 0 else -2.0", "-2.0 if error < 0 else 2.0", "-2.0 if error > 0 else 2.0"


@pytest.mark.parametrize(("side", "number"), [(SIDES[0], 0), (SIDES[1], 0), (SIDES[2], 1)])
def test_the_side_to_which_a_robot_turns(side, number):
    text = RIGHT.replace("max(-1.0, min(1.0, 2 * error))", side)
    assert [each["about"] for each in suspects(text.encode())] == ["sign"] * number
    text = RIGHT.replace("error))", "error))\n        if error > 0.5:\n            command.angular.z = -1.0")
    assert "on the left, and angular.z becomes -1.0" in suspects(text.encode())[0]["said"]


BACK = """
class Planner:
    def trace(self, before, cell):
        path = []
        while cell is not None:
            path.append(cell)
            cell = before[cell]
        return path
class Driver:
    def aim(self):
        {}
        return self.path[-1]
"""


@pytest.mark.parametrize(("first", "said"), [("for cell in self.path: self.look(cell)", True), ("pass", False)])
def test_a_way_from_the_goal_that_is_followed_from_its_first_cell(first, said):
    assert any("nothing turns it round" in each["said"] for each in suspects(BACK.format(first).encode())) == said
