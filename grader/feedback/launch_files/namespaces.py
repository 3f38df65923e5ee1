"""Namespaces and remapping rules of a launch file that reach more, or less, than they were meant for.

Source: https://github.com/ros2/launch_ros, launch_ros/launch_ros/actions/push_ros_namespace.py
Source: https://design.ros2.org/articles/static_remapping.html
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import called, calls, last_name, parsed, walk
from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place, argument, text

PUSHES = ("PushRosNamespace", "PushROSNamespace")
CREATES = ("create_subscription", "create_publisher", "create_client", "create_service")
LOOPS = ast.For | ast.ListComp | ast.GeneratorExp


@launch_slip
def pushed_without_group(file: LaunchFile) -> Iterator[Place]:
    """Find a namespace that is pushed several times in a file without a group, so that each goes below the last."""
    if any(file.calls("GroupAction", "PopLaunchConfigurations", "PopEnvironment")):
        return
    pushed = list(file.calls(*PUSHES))
    if len(pushed) == 1 and not _again_and_again(file, pushed[0]):
        return
    for call in pushed[:1]:
        yield (
            call.lineno,
            f"{last_name(call.func)} holds for all actions that come after it, so the second namespace is put below "
            "the first: a GroupAction around what belongs to one robot keeps its namespace inside",
        )


def _again_and_again(file: LaunchFile, call: ast.Call) -> bool:
    """Whether a call is in a loop, or in a function that is called in one."""
    around = [each.name for each in file.nodes if isinstance(each, ast.FunctionDef) and call in walk(each)]
    loops = [each for each in file.nodes if isinstance(each, LOOPS)]
    return any(call in walk(loop) or called(loop) & set(around) for loop in loops)


@launch_slip
def groups_for_processes(file: LaunchFile) -> Iterator[Place]:
    """Find a namespace that is pushed in a group whose only programs are processes, which do not get it."""
    for group in file.calls("GroupAction"):
        parts = [each for part in file.parts(group) for each in walk(part)]
        names = {last_name(each.func) for each in parts if isinstance(each, ast.Call)}
        started = [each for each in parts if isinstance(each, ast.Call) and last_name(each.func) == "ExecuteProcess"]
        push = next((each for each in parts if isinstance(each, ast.Call) and last_name(each.func) in PUSHES), None)
        others = names & {"Node", "LifecycleNode", "IncludeLaunchDescription", "OpaqueFunction"}
        if push is None or not started or others or any("__ns" in text(each) for each in parts):
            continue
        yield (
            push.lineno,
            f"{last_name(push.func)} reaches Node actions only: the program of the ExecuteProcess in line "
            f"{started[0].lineno} gets its namespace by its own words, --ros-args -r __ns:=/NAMESPACE",
        )


@launch_slip
def slashes_in_rules(file: LaunchFile) -> Iterator[Place]:
    """Find `-r /front/odom:=...` for a node in a namespace whose own name for the topic is `front/odom`."""
    if not any("__ns:=" in text(each) for each in file.nodes):
        return
    own = {name for content in file.beside.values() for name in _topics(content)}
    behind = {id(each) for node in file.nodes if isinstance(node, ast.JoinedStr) for each in node.values}
    for node in file.nodes:
        if id(node) in behind:
            continue  # no rule begins here
        first = node.values[0] if isinstance(node, ast.JoinedStr) and node.values else node
        said = text(first)
        name = said.partition(":=")[0]
        if ":=" in said and name.startswith("/") and name not in own and name[1:] in own:
            yield (
                node.lineno,  # type: ignore[attr-defined]
                f"the rule {name}:=... does not fit: the node calls its topic {name[1:]}, which its namespace turns "
                f"into another name than {name}; write {name[1:]}:=... without the / at the beginning",
            )
            return


@launch_slip
def exchanged_rules(file: LaunchFile) -> Iterator[Place]:
    """Find `-r /robot1/odom:=front/odom` for a node whose own name for the topic is `front/odom`."""
    own = {name for content in file.beside.values() for name in _topics(content)}
    behind = {id(each) for node in file.nodes if isinstance(node, ast.JoinedStr) for each in node.values}
    for node in file.nodes:
        if id(node) in behind or not isinstance(node, ast.JoinedStr | ast.Constant):
            continue
        parts = node.values if isinstance(node, ast.JoinedStr) else [node]
        said = "".join(text(each) or "{}" for each in parts)
        old, rule, new = said.partition(":=")
        if rule and new in own and old.startswith("/") and old not in own and old.rpartition("/")[2]:
            yield (
                node.lineno,
                f"the two names of this rule are exchanged: it is FROM:=TO, and the node's own name is {new}, so "
                f"`{new}:=` comes first",
            )
            return


def _topics(content: bytes) -> set[str]:
    """Return the names of topics and services that a program gives as texts."""
    tree = parsed(content)
    given = [argument(call, "topic", 1) for call, name in calls(tree) if name in CREATES]
    return {text(each) for each in given} - {""}


@launch_slip
def namespaces_in_the_environment(file: LaunchFile) -> Iterator[Place]:
    """Find the variable that ROS 1 read for the namespace of a node."""
    for node in file.nodes:
        if text(node) == "ROS_NAMESPACE":
            yield (
                node.lineno,  # type: ignore[attr-defined]
                "ROS_NAMESPACE is a variable of ROS 1, and no node of ROS 2 reads it: the namespace is namespace= of "
                "Node, or --ros-args -r __ns:=/NAMESPACE in a command",
            )
            return
