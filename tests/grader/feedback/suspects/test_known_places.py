"""What keeps the places of posts in a wrong way is found, and right ways are accused of nothing."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from math import cos, hypot, sin


class Node:
    def remember(self, ahead, left):
        x = ahead * cos(self.heading) - left * sin(self.heading)
        y = ahead * sin(self.heading) + left * cos(self.heading)
        {body}

    def known(self, x, y):
        return {known}

    def drive(self):
        self.counts.publish(Int32(data=len(self.posts)))
        self.target = min(self.posts, key=lambda post: hypot(*post), default=(0, 0))
"""
ALL = "all(hypot(x - a, y - b) > 0.5 for a, b in self.posts)"
RIGHT = [
    f"if {ALL}:\n            self.posts.append((x, y))",
    f"if not {ALL.replace('all', 'any').replace('>', '<')}:\n            self.posts.append((x, y))",
    "for a, b in self.posts:\n            if hypot(x - a, y - b) < 0.5:\n                return\n"
    "        self.posts.append((x, y))",
    f"if {ALL}:\n            self.posts.add((round(x, 2), round(y, 2)))",
    "for i, (a, b) in enumerate(self.posts):\n            if hypot(x - a, y - b) > 0.5:\n                continue\n"
    "            return\n        self.posts.append((x, y))",
    "new = True\n        for a, b in self.posts:\n            if hypot(x - a, y - b) < 0.5:\n"
    "                new = False\n        if new:\n            self.posts.append((x, y))",
]


@pytest.mark.parametrize("body", RIGHT)
def test_right_ways(body):
    assert suspects(FILE.format(body=body, known=0).encode()) == []


def test_a_right_way_with_another_method():
    body = "if not self.known(x, y):\n            self.posts.add((x, y))"
    assert suspects(FILE.format(body=body, known=ALL.replace("all", "any").replace(">", "<")).encode()) == []


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("if hypot(x - self.posts[-1][0], y) > 1:\n            self.posts.append((x, y))", "the last one found"),
        ("if hypot(x - self.posts[0][0], y) > 1:\n            self.posts.append((x, y))", "the first one found"),
        ("self.posts.add((round(x, 1), round(y, 1)))", "keeps rounded numbers"),
        ("self.posts[round(x, 1), round(y, 1)] = (x, y)", "keeps rounded numbers"),
        ("cell = int(x // 0.5), int(y // 0.5)\n        self.posts.add(cell)", "keeps rounded numbers"),
        ("if (x, y) not in self.posts:\n            self.posts.append((x, y))", "never equal to the last digit"),
        (
            "for a, b in self.posts:\n            if hypot(x - a, y - b) > 0.5:\n"
            "                self.posts.append((x, y))\n                break",
            "is done in the loop",
        ),
        (f"if {ALL.replace('>', '<')}:\n            self.posts.append((x, y))", "near all known posts"),
        (f"if {ALL.replace('all', 'any')}:\n            self.posts.append((x, y))", "only if all are"),
    ],
)
def test_wrong_ways(body, words):
    found = suspects(FILE.format(body=body, known=0).encode())
    assert [each["about"] for each in found] == ["same"] and words in found[0]["said"], found


def test_points_that_are_not_turned():
    text = FILE.format(body=RIGHT[0], known=0).replace("cos(self.heading)", "1").replace("sin(self.heading)", "0")
    assert [each["about"] for each in suspects(text.encode())] == ["unturned"]
