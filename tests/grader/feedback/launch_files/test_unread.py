"""Arguments that nobody reads, braces without an f, and parameters that a node does not declare."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

RIGHT = """\
def robot(number):
    return Node(executable="create", arguments=["-name", f"robot{number}", "-x", "{}".format(number)])


def generate_launch_description():
    driver = Node(
        executable=sys.executable,
        arguments=[str(HERE / "driver.py")],
        parameters=[{"use_sim_time": True, "stop_at": LaunchConfiguration("stop_at")}],
    )
    return LaunchDescription([DeclareLaunchArgument("stop_at", default_value="1.0"), driver, robot(1)])
"""
WORLD = '[DeclareLaunchArgument("world"), LogInfo(msg=LaunchConfiguration("world")), Declare'
DRIVER = (
    b"class Driver(Node):\n    def __init__(self):\n        self.stop = self.declare_parameter('stop_at', 1.0).value\n"
)


def slips(text, driver=DRIVER):
    return " ".join(each["said"] for each in launch_places(text.encode(), {"driver.py": driver})["launch_slips"])


def test_a_right_file_has_none():
    assert slips(RIGHT) == ""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('LaunchConfiguration("stop_at")', "1.0", "the argument stop_at is declared, and nothing"),
        ('f"robot{number}"', '"robot{number}"', "has no f before its quotes"),
        ('"stop_at": Launch', '"distance": Launch', "driver.py declares no parameter distance"),
        ('"use_sim_time"', '"use_simtime"', "no node has a parameter use_simtime: the one that"),
    ],
)
def test_each_is_found(old, new, words):
    assert words in slips(RIGHT.replace(old, new).replace("[Declare", WORLD))


def test_what_is_not_known_is_no_mistake():
    read = RIGHT.replace('LaunchConfiguration("stop_at")', 'context.launch_configurations["stop_at"]')
    assert slips(read) == ""
    other = RIGHT.replace('"stop_at": Launch', '"distance": Launch')
    assert slips(other, DRIVER.replace(b"'stop_at'", b"NAME")) == "" and slips(other, b"pass") == ""


def test_a_parameter_for_another_program():
    nodes = {"driver.py": DRIVER, "ranger.py": b"class Ranger(Node):\n    pass\n"}

    def said(text):
        return " ".join(each["said"] for each in launch_places(text.encode(), nodes)["launch_slips"])

    wrong = RIGHT.replace('"driver.py"', '"ranger.py"')
    assert "stop_at is given to ranger.py here, which declares none; driver.py declares it" in said(wrong)
    assert said(RIGHT) == ""
