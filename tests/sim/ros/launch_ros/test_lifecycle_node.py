"""LifecycleNode and RosTimer: a launch with a ROS node of its own."""

import os
import sys

import pytest

from gz_course.sim.ros.launch.actions import EmitEvent, LogInfo, OpaqueFunction, RegisterEventHandler, Shutdown
from gz_course.sim.ros.launch.substitutions import EnvironmentVariable
from gz_course.sim.ros.launch_ros.actions import (
    LifecycleNode,
    LifecycleTransition,
    RosTimer,
    SetROSLogDir,
    SetUseSimTime,
)
from gz_course.sim.ros.launch_ros.event_handlers import OnStateTransition
from gz_course.sim.ros.launch_ros.events.lifecycle import ChangeState, matches_node_name
from gz_course.tests.sim.ros.ros2.conftest import ros_domain  # noqa: F401

NODE = f"""\
#!{sys.executable}
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class Arm(LifecycleNode):
    def on_configure(self, state):
        print("configured", flush=True)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        print("cleaned up", flush=True)
        return TransitionCallbackReturn.SUCCESS


rclpy.init()
try:
    rclpy.spin(Arm("arm"))
except BaseException:
    pass
"""


@pytest.fixture
def arm(package, ros_domain):  # noqa: F811
    path = package / "lib/my_robot/arm"
    path.write_text(NODE)
    path.chmod(0o755)
    options = {"package": "my_robot", "executable": "arm", "name": "arm", "output": "screen"}
    return lambda **more: LifecycleNode(**options, **more)


def said(result):
    return [line.partition("]: ")[2] for line in result.text.splitlines() if "[launch.user]" in line]


@pytest.mark.proof
def test_a_node_is_led_through_its_states(tell, arm):
    node = arm(namespace="robot", autostart=True)
    clean_up = LifecycleTransition(lifecycle_node_names=["/robot/arm"], transition_ids=["deactivate", 2])

    refused = EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_node_name("/robot/arm"), transition_id=3))

    def on(state, *entities, **options):
        wanted = {"target_lifecycle_node": node, "goal_state": state, **options}
        return RegisterEventHandler(OnStateTransition(entities=[LogInfo(msg=state), *entities], **wanted))

    result = tell(
        node,
        on("inactive", start_state="configuring"),
        on("active", clean_up),
        on("unconfigured", refused),
        RegisterEventHandler(
            OnStateTransition(start_state="cleaningup", goal_state="unconfigured", entities=[Shutdown(reason="done")])
        ),
    )  # fmt: skip
    assert result.code == 0, result.text
    assert said(result)[:3] == ["inactive", "active", "unconfigured"]
    assert "configured" in result.text and "cleaned up" in result.text


@pytest.mark.proof
def test_a_wait_for_a_lifecycle_node_ends_with_it(tell, package, ros_domain):  # noqa: F811
    node = LifecycleNode(package="my_robot", executable="tell", name="mute", autostart=True, output="screen")
    result = tell(node)
    assert result.code == 0
    assert "no longer waiting for the service '/mute/change_state'" in result.text


@pytest.mark.proof
def test_ros_time_and_the_log_folder_of_nodes(tell, ros_domain, tmp_path):  # noqa: F811
    """With simulated time and nobody who publishes it, the timer never ends; the shutdown ends it."""
    never = RosTimer(period=0.0001, actions=[LogInfo(msg="never")])
    soon = RosTimer(period=0.01, actions=[LogInfo(msg=EnvironmentVariable("ROS_LOG_DIR"))])
    assert said(tell(SetROSLogDir(str(tmp_path)), soon)) == [str(tmp_path)]
    assert os.environ["ROS_LOG_DIR"] != str(tmp_path)
    end = OpaqueFunction(function=lambda context: Shutdown(reason="enough"))
    assert said(tell(SetUseSimTime(True), never, end)) == []
