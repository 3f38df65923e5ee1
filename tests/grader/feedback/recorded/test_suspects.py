"""The suspect that a check names."""

from gz_course.grader.feedback.recorded.places import suspect

FOUND = [{"line": 3, "about": "angle", "said": "a"}, {"line": 7, "about": "heading", "said": "b"}]


def test_the_first_one_about_that_thing_is_named(record):
    told = record({}, facts={"suspects": FOUND})
    assert suspect(told, "heading", "ray") == "line 7: b" and suspect(told, "gyroscope") == ""


def test_among_the_nodes_of_a_launch_the_file_is_named(record):
    told = record({}, facts={"suspects": [FOUND[0] | {"file": "follower_node.py"}], "launch": {}})
    assert suspect(told, "angle") == "follower_node.py, line 3: a"
