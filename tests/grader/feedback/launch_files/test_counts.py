"""How many actions the loops of a launch file make at most."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

FILE = """\
NAMES = ["robot1", "robot2", "robot3"]


def robot(name):
    return Node(package="ros_gz_sim", executable="create", arguments=["-name", name])


def make(context):
    robots = int(LaunchConfiguration("robots").perform(context))
    return [robot(name) for name in ALL]
"""


@pytest.mark.parametrize(
    ("over", "count"),
    [
        ("NAMES", 3),
        ("NAMES[:robots]", 3),
        ("range(1, 3)", 2),
        ("[name for _, name in enumerate(NAMES)]", None),
        ("range(robots)", None),
        ("zip(NAMES, range(robots))", 3),
        ("range(min(robots, 4))", 4),
    ],
)
def test_what_ends_a_loop(over, count):
    found = launch_places(FILE.replace("in ALL", f"in {over}").encode())["fixed_counts"]
    assert [each["count"] for each in found] == ([] if count is None else [count])


def test_actions_one_by_one():
    one = 'Node(package="ros_gz_sim", executable="create")'
    found = launch_places(f"actions = [{one}, {one}]\nprint(actions)\n".encode())["fixed_counts"]
    assert found[0]["count"] == 2 and "one by one" in found[0]["said"]
    assert launch_places(f"actions = [{one}]\nprint(actions)\n".encode())["fixed_counts"] == []
