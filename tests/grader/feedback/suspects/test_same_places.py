"""Rules by which two posts are the same for a wrong reason, and choices of another post than the nearest."""

import pytest

from gz_course.grader.feedback.suspects import suspects

FILE = """\
from math import cos, hypot, sin

SAME = {limit}


class Node:
    def remember(self, ahead, left):
        x = ahead * cos(self.heading) - left * sin(self.heading)
        y = ahead * sin(self.heading) + left * cos(self.heading)
        {body}

    def drive(self):
        self.counts.publish(Int32(data=len(self.posts)))
        self.target = {target}

    def on_pictures(self):
        {pictures}
"""
RIGHT = {
    "limit": "0.5",
    "body": "if all(hypot(x - a, y - b) > SAME for a, b in self.posts):\n            self.posts.append((x, y))",
    "target": "min(self.posts, key=lambda post: hypot(*post))",
    "pictures": "self.seen = []",
}


def found(**changed):
    text = FILE.format(**RIGHT | changed)
    return [(each["about"], each["said"]) for each in suspects(text.encode())]


@pytest.mark.parametrize(
    "test",
    [
        "all(abs(x - a) > SAME or abs(y - b) > SAME for a, b in self.posts)",
        "not any(abs(x - a) < SAME and abs(y - b) < SAME for a, b in self.posts)",
        "all(hypot(x - p[0], y - p[1]) > SAME for p in self.posts)",
        "all((np.abs(np.array(p) - (x, y)) > SAME).any() for p in self.posts)",
    ],
)
def test_right_rules(test):
    assert found(body=f"if {test}:\n            self.posts.append((x, y))") == []


@pytest.mark.parametrize(
    ("test", "words"),
    [
        ("all(abs(x - a) > SAME and abs(y - b) > SAME for a, b in self.posts)", "their x or their y"),
        ("not any(abs(x - a) < SAME or SAME > abs(y - b) for a, b in self.posts)", "their x or their y"),
        ("all((np.abs(np.array(p) - (x, y)) > SAME).all() for p in self.posts)", "their x or their y"),
        ("all(abs(x - a) > SAME for a, b in self.posts)", "compares one coordinate only"),
        ("not [p for p in self.posts if abs(p[1] - y) < SAME]", "compares one coordinate only"),
        ("all(abs((x - a) + (y - b)) > SAME for a, b in self.posts)", "cancel each other"),
    ],
)
def test_coordinates_that_are_compared_each_for_itself(test, words):
    ((about, said),) = found(body=f"if {test}:\n            self.posts.append((x, y))")
    assert about == "same" and words in said


@pytest.mark.parametrize(("limit", "words"), [("50", "for one"), ("0.01", "one post for several")])
def test_limits_that_are_no_metres(limit, words):
    ((about, said),) = found(limit=limit)
    assert about == "same" and f"with {float(limit):g} m" in said and words in said


@pytest.mark.parametrize(
    ("target", "which"),
    [
        ("min(self.posts)", "first numbers, x"),
        ("sorted(self.posts)[0]", "first numbers, x"),
        ("min(self.posts, key=lambda p: p[0])", "first numbers, x"),
        ("min(self.posts, key=lambda post: abs(post[0]), default=None)", "first numbers, x"),
        ("min(self.posts, key=lambda p: abs(p[1]))", "second numbers, y"),
    ],
)
def test_the_smallest_coordinate_is_not_the_nearest(target, which):
    ((about, said),) = found(target=target)
    assert about == "nearest" and f"compares the {which}" in said


def test_a_list_that_is_emptied_and_counted():
    ((about, said),) = found(pictures="self.posts = []")
    assert about == "same" and "emptied here again and again" in said


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "d = hypot(x, y)\n        if all(abs(d - hypot(*p)) > SAME for p in self.posts):\n            {add}",
            "distance",
        ),
        (
            "d = np.linalg.norm((x, y))\n        for p in self.posts:\n            "
            "if abs(np.linalg.norm(p) - d) < SAME:\n                return\n        {add}",
            "distance",
        ),
        ("d = hypot(x, y)\n        if all(abs(d - p) > SAME for p in self.posts):\n            {one}", "distance"),
        (
            "b = atan2(y, x)\n        if all(abs(b - atan2(*p[::-1])) > SAME for p in self.posts):\n            {add}",
            "direction",
        ),
        (
            "d, b = hypot(x, y), atan2(y, x)\n        if all(abs(d - hypot(*p)) > SAME or "
            "abs(b - atan2(p[1], p[0])) > 0.2 for p in self.posts):\n            {add}",
            "",
        ),
    ],
)
def test_one_measure_of_a_place_does_not_tell_posts_apart(body, words):
    said = found(body=body.format(add="self.posts.append((x, y))", one="self.posts.append(d)"))
    assert len(said) == bool(words) and all(f"compares only the {words}" in each for _, each in said), said


@pytest.mark.parametrize(("counted", "told"), [("len(here)", True), ("max(self.n, len(here))", True), ("7", False)])
def test_a_number_of_one_picture_that_is_published(counted, told):
    pictures = f"here = []\n        self.n = {counted}\n        self.counts.publish(Int32(data=self.n))"
    said = [about for about, _ in found(pictures=pictures)]
    assert said == ["one picture"] * told


@pytest.mark.parametrize("test", ["len(self.posts) < len(self.seen)", "x and len(self.seen) > len(self.posts)"])
def test_posts_that_are_told_apart_by_how_many_are_known(test):
    ((about, said),) = found(body=f"if {test}:\n            self.posts.append((x, y))")
    assert about == "same" and "decides by how many posts are known" in said


@pytest.mark.parametrize(
    ("key", "told"),
    [("lambda p: hypot(*p)", True), ("lambda p: hypot(p[0] - x, p[1] - y)", False), ("self.away", False)],
)
def test_a_point_that_is_compared_with_the_post_nearest_to_the_robot(key, told):
    body = (
        f"a, b = min(self.posts, key={key})\n        if hypot(x - a, y - b) > SAME:\n"
        "            self.posts.append((x, y))"
    )
    said = found(body=body)
    assert len(said) == told and all("nearest to the robot" in each for _, each in said), said
