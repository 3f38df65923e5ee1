"""Starts that are set anew in each call, and what comes after spin()."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """
class Teleop(Node):
    def tick(self):
        now = self.get_clock().now()
        {lines}

    def stop(self):
        self.publisher.publish(Twist())


def main():
    node = Teleop()
    rclpy.spin(node)
    {behind}


main()
"""
RIGHT = "if now - self.start < Duration(seconds=5):\n            self.publisher.publish(Twist())"


def said(lines: str = RIGHT, behind: str = "node.destroy_node()") -> list[str]:
    return [place["said"] for place in slips(NODE.format(lines=lines, behind=behind).encode(), duration=8.0)]


def test_a_right_file_has_no_slip():
    assert said() == []


def test_a_start_that_each_call_sets_anew_is_named():
    lines = "passed = now - self.start\n        self.start = now\n        if passed < Duration(seconds=5): pass"
    assert any("self.start is set again in every call of tick" in each for each in said(lines))


def test_zero_is_told_apart_from_none_only_by_is_none():
    init = "def __init__(self):\n        self.heading = None\n        self.count = 0\n\n    def on_imu(self, imu):\n"
    text = f"class A(Node):\n    {init}        if not self.heading:\n            self.heading = 0.0\n"
    assert any("0.0 counts as false" in place["said"] for place in slips(text.encode(), duration=8.0))
    right = text.replace("not self.heading", "self.heading is None")
    assert not any("counts as false" in place["said"] for place in slips(right.encode(), duration=8.0))


def test_steps_of_time_are_no_starts():
    lines = "step = now - self.before\n        self.before = now\n        if step > 0.5:\n            pass"
    assert said(lines) == []


@pytest.mark.parametrize("behind", ["node.stop()", "node.timer.cancel()"])
def test_what_is_meant_to_end_the_drive_does_not_run_behind_spin(behind):
    assert any("comes after spin()" in each for each in said(behind=behind))


@pytest.mark.parametrize("clause", ["except KeyboardInterrupt", "finally"])
@pytest.mark.parametrize("call", ["node.stop()", "node.publisher.publish(Twist())"])
def test_a_last_command_on_ctrl_c_is_no_fault(clause, call):
    text = NODE.format(lines=RIGHT, behind="node.destroy_node()")
    text = text.replace(
        "    rclpy.spin(node)\n", f"    try:\n        rclpy.spin(node)\n    {clause}:\n        {call}\n"
    )
    assert slips(text.encode(), duration=8.0) == []


def test_a_drive_that_begins_only_on_ctrl_c_is_named():
    text = NODE.format(lines="self.passed = now - self.start", behind="node.destroy_node()").replace("stop", "go")
    text = text.replace(
        "    rclpy.spin(node)\n", "    try:\n        rclpy.spin(node)\n    finally:\n        node.go()\n"
    )
    assert any("go() comes after spin()" in place["said"] for place in slips(text.encode(), duration=8.0))
