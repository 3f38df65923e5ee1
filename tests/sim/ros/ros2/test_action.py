"""`ros2 action` against a running server."""

import os
import re
import signal
import threading
from types import SimpleNamespace

import pytest

from gz_course.tests.sim.spinning import spinning

TYPE = "example_interfaces/action/Fibonacci"
NODE = "/robot/counter"
CLIENT = "/_ros2cli_send_goal_example_interfaces_action_Fibonacci"
ASKED = {
    "list": ["list"],
    "types": ["list", "-t"],
    "count": ["list", "-c"],
    "type": ["type", "/robot/count"],
    "type unknown": ["type", "/robot/cuont"],
    "find": ["find", "example_interfaces/Fibonacci"],
    "find count": ["find", "-c", TYPE],
    "info": ["info", "-c", "robot/count"],
    "info unknown": ["info", "/robot/cuont"],
    "goal": ["send_goal", "/robot/count", TYPE, "order: 3"],
    "aborted": ["send_goal", "robot/count", "example_interfaces/Fibonacci"],
    "rejected": ["send_goal", "/robot/count", TYPE, "{order: -1}"],
    "wrong field": ["send_goal", "/robot/count", TYPE, "{odrer: 3}"],
    "wrong value": ["send_goal", "/robot/count", TYPE, "{order: many}"],
    "wrong type": ["send_goal", "/robot/count", "tf2_msgs/action/LookupTransform"],
    "no type": ["send_goal", "/robot/count", "example_interfaces/action/Fibonaci"],
    "bad name": ["send_goal", "/a b", TYPE],
}
SENDING = "Waiting for an action server to become available...\nSending goal:\n     order: {}\n\n"
FEEDBACK = "Feedback:\n    sequence:\n- 0\n- 1\n\n"
RESULT = "Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\nGoal finished with status: SUCCEEDED\n"


@pytest.fixture(scope="module")
def counter(ros_domain):
    """Return the node /robot/counter with the action /robot/count.

    It rejects an order below 0, aborts 0, and gives feedback until it is cancelled from 100.
    """
    import rclpy
    from example_interfaces.action import Fibonacci
    from rclpy.action import ActionServer, CancelResponse, GoalResponse
    from rclpy.callback_groups import ReentrantCallbackGroup
    from rclpy.executors import MultiThreadedExecutor

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = rclpy.create_node("counter", namespace="/robot", context=context, start_parameter_services=False)
    cancelled = threading.Event()

    def execute(handle):
        order = handle.request.order
        sequence = [0, 1]
        if order >= 100:
            while not cancelled.wait(0.1):
                handle.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            handle.canceled()
            return Fibonacci.Result()
        for _ in range(1, order):
            sequence.append(sequence[-2] + sequence[-1])
        handle.succeed() if order else handle.abort()
        return Fibonacci.Result(sequence=sequence)

    def cancel(handle):
        cancelled.set()
        return CancelResponse.ACCEPT

    server = ActionServer(
        node,
        Fibonacci,
        "count",
        execute,
        callback_group=ReentrantCallbackGroup(),
        goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
        cancel_callback=cancel,
    )
    executor = MultiThreadedExecutor(2, context=context)
    executor.add_node(node)
    with spinning(executor):
        yield node
        cancelled.set()
    server.destroy()
    node.destroy_node()
    context.try_shutdown()


@pytest.fixture(scope="module")
def answers(counter, run_together):
    # The clients that send goals would change what the others print.
    found = {}
    for sending in (False, True):
        names = [name for name, words in ASKED.items() if (words[0] == "send_goal") == sending]
        found |= zip(names, run_together(*(["action", *ASKED[name]] for name in names)), strict=True)
    return found


def test_list_type_and_find(answers):
    assert answers["list"] == (0, "/robot/count\n", "")
    assert answers["types"] == (0, f"/robot/count [{TYPE}]\n", "")
    assert answers["count"] == (0, "1\n", "")
    assert answers["type"] == (0, f"{TYPE}\n", "")
    assert answers["find"] == (0, "/robot/count\n", "")
    assert answers["find count"] == (0, "1\n", "")


def test_info(answers):
    assert answers["info"] == (0, "Action: robot/count\nAction clients: 0\nAction servers: 1\n", "")
    assert answers["info unknown"] == (
        0,
        "Action: /robot/cuont\nAction clients: 0\nAction servers: 0\n",
        "Unknown action '/robot/cuont'; did you mean '/robot/count'?\n",
    )


def test_a_node_that_has_ended_meanwhile_has_no_actions(counter):
    from rclpy.action.graph import get_action_client_names_and_types_by_node, get_action_server_names_and_types_by_node

    from gz_course.sim.ros.ros2.action import nodes_with

    graph = SimpleNamespace(node=counter, nodes=lambda hidden: ["/gone", NODE])
    assert nodes_with(graph, "/robot/count", get_action_server_names_and_types_by_node) == [(NODE, [TYPE])]
    assert nodes_with(graph, "/robot/count", get_action_client_names_and_types_by_node) == []


@pytest.mark.parametrize(
    ("asked", "order", "ends"),
    [
        ("goal", 3, RESULT),
        ("aborted", 0, "Result:\n    sequence:\n- 0\n- 1\n\nGoal finished with status: ABORTED\n"),
    ],
)
def test_a_goal_is_sent_and_its_result_printed(answers, asked, order, ends):
    code, text, errors = answers[asked]
    assert (code, errors) == (0, "")
    assert re.sub("(?<=ID: )[0-9a-f]{32}", "…", text) == f"{SENDING.format(order)}Goal accepted with ID: …\n\n{ends}"


def test_a_goal_is_rejected(answers):
    assert answers["rejected"] == (0, f"{SENDING.format(-1)}Goal was rejected.\n", "")


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ("type unknown", "Unknown action '/robot/cuont'; did you mean '/robot/count'?"),
        (
            "wrong field",
            "Failed to populate field: Fibonacci_Goal has no field 'odrer', its fields: order; did you mean",
        ),
        ("wrong value", "Failed to populate field: 'order' of Fibonacci_Goal is a whole number (int32), not 'many'"),
        ("wrong type", f"The action /robot/count has the type {TYPE}, not tf2_msgs/action/LookupTransform"),
        ("no type", f"The action type '{TYPE[:-3]}ci' is invalid; did you mean '{TYPE}'?"),
        ("bad name", "'/a b' is not an action name: "),
    ],
)
def test_what_is_wrong_is_one_sentence(answers, asked, sentence):
    code, _, errors = answers[asked]
    assert code == 1
    assert errors.startswith(sentence)
    assert len(errors.splitlines()) == 1


def test_an_interrupt_cancels_the_goal(start, ros2, counter):
    command = start("action", "send_goal", "-f", "/robot/count", TYPE, "--stdin", stdin_text="order: 100")
    command.wait_for("Goal accepted")
    command.wait_for("Feedback:", times=2)
    ends = f"Action clients: 1\n    {CLIENT} [{TYPE}]\nAction servers: 1\n    {NODE} [{TYPE}]\n"
    assert ros2("action", "info", "-t", "/robot/count") == (0, f"Action: /robot/count\n{ends}", "")
    os.kill(command.process.pid, signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (2, "")
    assert FEEDBACK in text
    assert "Canceling goal...\n" in text
    assert text.endswith("Goal canceled.\n")


def test_a_name_without_a_server_is_waited_for(start, counter):
    command = start("action", "send_goal", "/robot/cuont", TYPE)
    command.wait_for("The action /robot/cuont is not available yet; did you mean '/robot/count'?", "stderr")
    os.kill(command.process.pid, signal.SIGINT)
    code, text, _ = command.wait()
    assert (code, text) == (2, "Waiting for an action server to become available...\n")


def test_the_parts_of_an_action_are_hidden(run_together, counter):
    for _, text, _ in run_together(["topic", "list"], ["service", "list"]):
        assert "_action" not in text


def test_tab_completes_names_and_types(offered, counter):
    assert offered("action", "info", "/robot/c") == ["/robot/count"]
    assert offered("action", "send_goal", "/robot/count", "") == [TYPE]
