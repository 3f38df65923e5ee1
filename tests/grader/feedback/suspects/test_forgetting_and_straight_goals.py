"""What is set back in each call, and goals that are the nearest in a straight line."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
class Mapper(Node):
    def __init__(self):
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.create_publisher(OccupancyGrid, "/map", 10)
        self.odds = np.zeros((80, 100))
        self.way = []

    def on_scan(self, scan):
        self.way = []
        self.odds[self.cells(scan)] += 1

    def goal(self, cells, x, y):
        return max(cells)
"""


def found(new: str, about: str, old: str = "        self.way = []\n        self.odds[") -> list[str]:
    text = NODE.replace(old, new)
    assert text != NODE
    return [each["said"] for each in suspects(text.encode()) if each["about"] == about]


def test_a_right_node_has_none():
    assert suspects(NODE.encode()) == []


@pytest.mark.parametrize("again", ["self.odds = np.zeros((80, 100))", "self.odds.fill(0)", "self.odds[:] = 0"])
def test_what_is_set_back_is_found(again):
    assert "all that was seen before is forgotten" in found(f"        {again}\n        self.odds[", "forgets")[0]


def test_what_is_set_back_under_a_condition_is_none():
    again = "        if self.moved:\n            self.odds = np.zeros((80, 100))\n        self.odds["
    assert found(again, "forgets") == []


@pytest.mark.parametrize(
    "nearest",
    ["min(cells, key=lambda c: hypot(c[0] - x, c[1] - y))", "cells[np.argmin(np.hypot(cells[0] - x, cells[1] - y))]"],
)
def test_the_nearest_goal_in_a_straight_line_is_found(nearest):
    assert "a wall may stand between" in found(nearest, "straight", "max(cells)")[0]
    searched = f"{nearest}\n\n    def search(self):\n        while todo:\n            todo.append(todo.popleft())"
    assert found(searched, "straight", "max(cells)") == []
