"""`ros2 lifecycle` against a real lifecycle node, in this process."""

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from gz_course.sim.ros.ros2.command_line import main
from gz_course.tests.sim.ros.ros2.conftest import spinning


class Arm(LifecycleNode):
    """Is configured at the second request."""

    def __init__(self, **options):
        super().__init__("arm", namespace="/robot", **options)
        self.asked = 0

    def on_configure(self, state):
        self.asked += 1
        return TransitionCallbackReturn.SUCCESS if self.asked > 1 else TransitionCallbackReturn.FAILURE


@pytest.fixture
def arm(ros_domain):
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = Arm(context=context)
    other = rclpy.create_node("plain", namespace="/robot", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    executor.add_node(other)
    with spinning(executor):
        yield node
    node.destroy_node()
    other.destroy_node()
    context.try_shutdown()


CONFIGURE = "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"


@pytest.mark.proof
def test_the_life_of_a_node(arm, capsys):
    def ros2(*words):
        code = main(["lifecycle", *words])
        seen = capsys.readouterr()
        return code, seen.out, seen.err

    listed = (ros2("nodes") for _ in range(20))  # on a busy machine a list may be taken before a node is found
    assert next(filter(lambda each: each[1], listed), None) == (0, "/robot/arm\n", "")
    assert ros2("get", "/robot/arm") == (0, "unconfigured [1]\n", "")
    assert ros2("set", "/robot/arm", "configure") == (1, "", "Transitioning failed\n")
    code, text, _ = ros2("list", "robot/arm")
    assert (code, text.startswith(CONFIGURE)) == (0, True)
    assert ros2("set", "/robot/arm", "1") == (0, "Transitioning successful\n", "")
    assert ros2("get") == (0, "/robot/arm: inactive [2]\n", "")
    code, _, errors = ros2("set", "/robot/arm", "fly")
    assert code == 1 and errors.startswith("Unknown transition requested, available ones are:\n- cleanup [2]\n")
    assert ros2("get", "/robot/arn") == (1, "", "Node not found; did you mean '/robot/arm'?\n")
    code, _, errors = ros2("get", "/robot/plain")
    assert (code, errors) == (1, "The node /robot/plain is no lifecycle node; did you mean '/robot/arm'?\n")
    assert len(ros2("list", "-a", "/robot/arm")[1]) > len(text)
