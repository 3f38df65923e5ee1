"""Programs under a condition on the argument that pauses the world."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

FILE = """\
def generate_launch_description():
    paused = LaunchConfiguration("paused")
    watch = Node(executable="python3", arguments=["stopwatch.py"]{condition})
    return LaunchDescription([
        DeclareLaunchArgument("paused", default_value="false"),
        ExecuteProcess(cmd=["gz", "sim", "-s", "-r", "world.sdf"], condition=UnlessCondition(paused)),
        ExecuteProcess(cmd=["gz", "sim", "-s", "world.sdf"], condition=IfCondition(paused)),
        watch,
        {more}
    ])
"""
OTHER = 'Node(executable="python3", arguments=["stopwatch.py"], condition=IfCondition(paused)),'


def said(condition="", more=""):
    places = launch_places(FILE.format(condition=condition, more=more).encode())["launch_slips"]
    return [(each["line"], each["said"]) for each in places]


@pytest.mark.parametrize(("kind", "value"), [("UnlessCondition", "false"), ("IfCondition", "true")])
def test_a_program_of_one_case_is_named(kind, value):
    ((line, words),) = said(condition=f", condition={kind}(paused)")
    assert line == 3 and words.startswith(f"{kind}(paused) starts this only if paused is {value}")


def test_so_is_a_group_of_them():
    ((line, words),) = said(more='GroupAction([Node(package="a", executable="b")], condition=IfCondition(paused)),')
    assert line == 9 and "starts this only if paused is true" in words


@pytest.mark.parametrize(
    ("condition", "more"),
    [
        ("", ""),
        (", condition=UnlessCondition(paused)", OTHER),
        (", condition=IfCondition(LaunchConfiguration('rviz'))", ""),
        (
            "",
            'Node(package="ros_gz_sim", executable="gz_sim", arguments=["gz sim -r"], condition=IfCondition(paused)),',
        ),
    ],
)
def test_what_may_be_meant_is_not(condition, more):
    assert said(condition, more) == []
