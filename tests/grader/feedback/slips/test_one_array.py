"""One array with two names, and nanoseconds without their seconds."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """\
class Mapper(Node):
    def __init__(self):
        self.hits = np.zeros((80, 100))
        self.passes = np.zeros((80, 100))

    def on_scan(self, scan):
        taken = scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9
        self.hits[self.walls(taken)] += 1
        np.add.at(self.passes, self.free(taken), 1)
"""
TWO = "self.hits = np.zeros((80, 100))\n        self.passes = np.zeros((80, 100))"


def said(old: str, new: str) -> list[str]:
    text = NODE.replace(old, new)
    assert text != NODE
    return [each["said"] for each in slips(text.encode())]


def test_a_right_node_has_none():
    assert slips(NODE.encode()) == []


@pytest.mark.parametrize(
    "one",
    [
        "self.hits = self.passes = np.zeros((80, 100))",
        "self.hits = np.zeros((80, 100))\n        self.passes = self.hits",
    ],
)
def test_two_names_of_one_array_are_found(one):
    assert "gives one array two names" in said(TWO, one)[0]


def test_two_names_of_a_number_are_none():
    assert said(TWO, "self.hits = self.passes = 0") == []


def test_nanoseconds_alone_are_found():
    assert "sec is read nowhere" in said("scan.header.stamp.sec + ", "")[0]
    assert said("taken = scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9", "out.nanosec = scan.nanosec") == []


def test_two_names_of_one_set_in_a_function_are_found():
    text = "def f():\n    a = b = set()\n    a.add(1)\n    b.update([2])\n"
    assert "what is added to a is in b" in slips(text.encode())[0]["said"]
    assert slips(text.replace("b.update([2])", "print(b)").encode()) == []
