"""Goals of an action of one's own go over DDS: built from its text, without a compiler."""

import importlib
import os
import sys
import threading
from pathlib import Path

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.executors import SingleThreadedExecutor

from gz_course.sim.ros.ament_cmake.build import Package, build
from gz_course.tests.sim.ros.ros2.conftest import ros_domain  # noqa: F401
from gz_course.tests.sim.spinning import spinning

NAME = "garden_actions"
DEADLINE = 60.0  # [s]
FILES = {
    "package.xml": f"<package><name>{NAME}</name><depend>geometry_msgs</depend>"
    "<member_of_group>rosidl_interface_packages</member_of_group>"
    "<export><build_type>ament_cmake</build_type></export></package>",
    "CMakeLists.txt": f"project({NAME})\nfind_package(rosidl_default_generators REQUIRED)\n"
    "find_package(geometry_msgs REQUIRED)\n"
    "rosidl_generate_interfaces(${PROJECT_NAME} msg/Hole.msg action/Dig.action DEPENDENCIES geometry_msgs)\n"
    "ament_package()\n",
    "msg/Hole.msg": "geometry_msgs/Point place\nfloat32 depth\n",
    "action/Dig.action": "Hole[] holes\nstring<=20 tool spade\n---\nfloat64 earth\nHole deepest\n---\nuint8 done\n",
}


@pytest.fixture
def garden(tmp_path, monkeypatch):
    """Return the modules `msg` and `action` of a package that was built here."""
    for name, text in FILES.items():
        path = tmp_path / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    built = build(Package(tmp_path / "src", tmp_path / "build", tmp_path / "install"), [Path(sys.prefix)])
    assert (built.faults, built.remarks) == ([], [])
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path / 'install'}{os.pathsep}{os.environ['AMENT_PREFIX_PATH']}")
    yield importlib.import_module(f"{NAME}.msg"), importlib.import_module(f"{NAME}.action")
    for name in [name for name in sys.modules if name.partition(".")[0] == NAME]:
        del sys.modules[name]


def outcome(future):
    """Wait for a future that another thread spins."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    assert done.wait(DEADLINE)
    return future.result()


def test_a_goal_its_feedback_its_result_and_its_cancelling(garden, ros_domain):  # noqa: F811
    msg, action = garden
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    nodes = [rclpy.create_node(name, context=context) for name in ("gardener", "owner")]
    cancelled = rclpy.task.Future()

    async def dig(handle):
        for number, _ in enumerate(handle.request.holes, 1):
            handle.publish_feedback(action.Dig.Feedback(done=number))
        if handle.request.tool == "spoon":
            await cancelled
            handle.canceled()
            return action.Dig.Result()
        handle.succeed()
        deepest = max(handle.request.holes, key=lambda hole: hole.depth)
        return action.Dig.Result(earth=sum(hole.depth for hole in handle.request.holes), deepest=deepest)

    def cancel(_):
        cancelled.set_result(True)
        return CancelResponse.ACCEPT

    server = ActionServer(
        nodes[0],
        action.Dig,
        "/dig",
        dig,
        goal_callback=lambda goal: GoalResponse.ACCEPT if goal.holes else GoalResponse.REJECT,
        cancel_callback=cancel,
    )
    client = ActionClient(nodes[1], action.Dig, "/dig")
    executor = SingleThreadedExecutor(context=context)
    for node in nodes:
        executor.add_node(node)
    fed = []
    with spinning(executor):
        assert client.wait_for_server(DEADLINE)
        assert not outcome(client.send_goal_async(action.Dig.Goal())).accepted
        holes = [msg.Hole(depth=0.5), msg.Hole(depth=2.0)]
        holes[1].place.x = 3.5
        goal = outcome(client.send_goal_async(action.Dig.Goal(holes=holes), lambda got: fed.append(got.feedback.done)))
        assert goal.accepted
        got = outcome(goal.get_result_async())
        assert (got.status, got.result.earth) == (GoalStatus.STATUS_SUCCEEDED, 2.5)
        assert got.result.deepest == holes[1]
        goal = outcome(client.send_goal_async(action.Dig.Goal(holes=holes[:1], tool="spoon")))
        result = goal.get_result_async()
        assert len(outcome(goal.cancel_goal_async()).goals_canceling) == 1
        assert outcome(result).status == GoalStatus.STATUS_CANCELED
    assert set(fed) <= {1, 2}
    client.destroy()
    server.destroy()
    for node in nodes:
        node.destroy_node()
    context.try_shutdown()
