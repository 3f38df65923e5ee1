"""TimerAction: the scope that its actions see, and what they leave."""

from gz_course.sim.ros.launch.actions import (
    GroupAction,
    LogInfo,
    OpaqueFunction,
    SetLaunchConfiguration,
    TimerAction,
)
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration


def said(result):
    return [line.removeprefix("[INFO] [launch.user]: ") for line in result.lines if "[launch.user]" in line]


def later(period, *actions):
    return TimerAction(period=period, actions=list(actions))


def value_of(name):
    return LogInfo(msg=[f"{name}=", LaunchConfiguration(name, default="-")])


def test_a_timer_sees_the_configurations_of_its_own_moment_and_leaks_nothing(run):
    result = run(
        SetLaunchConfiguration("a", "before"),
        later(0.0, value_of("a"), SetLaunchConfiguration("a", "inside"), SetLaunchConfiguration("b", "inside")),
        SetLaunchConfiguration("a", "after"),
        later(0.05, value_of("a"), value_of("b")),
    )
    assert said(result) == ["a=before", "a=after", "b=-"]


def test_a_timer_keeps_the_scope_of_its_group(run):
    group = GroupAction([SetLaunchConfiguration("a", "group"), later(0.0, value_of("a"), later(0.0, value_of("a")))])
    assert said(run(group, value_of("a"))) == ["a=-", "a=group", "a=group"]


def test_an_error_among_the_actions_of_a_timer_leaves_no_scope_open(run):
    failing = OpaqueFunction(function=lambda context: 1 / 0)
    result = run(SetLaunchConfiguration("a", "outside"), later(0.0, SetLaunchConfiguration("a", "inside"), failing))
    assert result.code == 1
    assert "division by zero" in result.text
