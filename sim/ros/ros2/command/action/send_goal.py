"""Send an action goal."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient

from gz_course.sim.ros.ros2 import interruption
from gz_course.sim.ros.ros2.action import action_name, nearest_action
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import Graph, add_graph_options
from gz_course.sim.ros.ros2.interface import action_class, action_type_name
from gz_course.sim.ros.ros2.message_text import TextFormat, to_yaml
from gz_course.sim.ros.ros2.message_value import fill
from gz_course.sim.ros.ros2.topic import warn

_STATUS = {
    GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
    GoalStatus.STATUS_EXECUTING: "EXECUTING",
    GoalStatus.STATUS_CANCELING: "CANCELING",
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}
_NOT_ACTIVE = {
    GoalStatus.STATUS_CANCELING,
    GoalStatus.STATUS_SUCCEEDED,
    GoalStatus.STATUS_CANCELED,
    GoalStatus.STATUS_ABORTED,
}
_WHOLE = TextFormat(limit=None)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_graph_options(parser)
    parser.add_argument("action_name", help="Name of the ROS action (e.g. '/fibonacci')")
    parser.add_argument("action_type", help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')")
    goal = parser.add_mutually_exclusive_group()
    goal.add_argument(
        "goal",
        nargs="?",
        default="{}",
        help="Goal request values in YAML format (e.g. '{order: 10}'), otherwise default values",
    )
    goal.add_argument("--stdin", action="store_true", help="Read goal from standard input")
    parser.add_argument("-f", "--feedback", action="store_true", help="Echo feedback messages for the goal")


def main(arguments: argparse.Namespace) -> None:
    """Send one goal and wait for its result; cancel it when interrupted."""
    kind = action_class(arguments.action_type)
    type_name = action_type_name(kind)
    goal = kind.Goal()
    stamps = fill(goal, sys.stdin.read() if arguments.stdin else arguments.goal)
    with Graph(arguments, f"_ros2cli_send_goal_{type_name.replace('/', '_')}") as graph:
        name = action_name(graph, arguments.action_name)
        client: Any = ActionClient(graph.node, kind, name)
        _wait_for_server(graph, client, name, type_name)
        now = graph.node.get_clock().now().to_msg()
        for stamp in stamps:
            stamp(now)
        print(f"Sending goal:\n     {to_yaml(goal, _WHOLE)}")
        sent = client.send_goal_async(goal, _print_feedback if arguments.feedback else None)
        handle = _answer(graph, client, name, sent)
        if not handle.accepted:
            print("Goal was rejected.")
            return
        try:
            print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
            ended = _answer(graph, client, name, handle.get_result_async())
        except KeyboardInterrupt:
            if handle.status not in _NOT_ACTIVE:
                interruption.listen()  # a second signal ends the command at once
                _cancel(graph, client, name, handle)
            raise
        print(f"Result:\n    {to_yaml(ended.result, _WHOLE)}")
        print(f"Goal finished with status: {_STATUS.get(ended.status, 'UNKNOWN')}")


def _print_feedback(message: Any) -> None:
    print(f"Feedback:\n    {to_yaml(message.feedback, _WHOLE)}")


def _wait_for_server(graph: Graph, client: Any, name: str, type_name: str) -> None:
    """Wait until the server is there, for ever; say what stands against it."""
    print("Waiting for an action server to become available...")
    if graph.wait_for(client.server_is_ready):
        return
    others = [kind for kind in dict(graph.actions()).get(name, []) if kind != type_name]
    if others:
        raise CommandError(f"The action {name} has the type {', '.join(others)}, not {type_name}")
    warn(f"The action {name} is not available yet{nearest_action(graph, name)}")
    graph.spin_until(client.server_is_ready)


def _answer(graph: Graph, client: Any, name: str, future: Any) -> Any:
    """Return the server's answer. Raises CommandError if the server disappears before."""
    gone = False

    def decided() -> bool:
        nonlocal gone
        gone = not future.done() and not client.server_is_ready()
        return future.done() or gone

    graph.spin_until(decided)
    if gone:
        raise CommandError(f"The server of the action {name} has gone without an answer")
    return future.result()


def _cancel(graph: Graph, client: Any, name: str, handle: Any) -> None:
    print("Canceling goal...")
    response = _answer(graph, client, name, handle.cancel_goal_async())
    if handle.goal_id not in [goal.goal_id for goal in response.goals_canceling]:
        raise CommandError("Failed to cancel goal")
    print("Goal canceled.")
