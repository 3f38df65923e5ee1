"""Loops that spin for ever, and defaults that grow."""

import pytest

from gz_course.grader.feedback.slips import slips

LOOP = """\
rclpy.init()
node = Follower()
while True:
    try:
        rclpy.spin_once(node, timeout_sec=0.1)
    except EXCEPT
"""


@pytest.mark.parametrize(
    ("handler", "words"),
    [
        ("BaseException:\n        pass", "catches the KeyboardInterrupt"),
        ("(KeyboardInterrupt, ExternalShutdownException):\n        continue", "leave the loop here with break"),
        ("KeyboardInterrupt:\n        break", ""),
        ("Exception:\n        pass", ""),
        ("KeyboardInterrupt:\n        sys.exit(0)", ""),
        ("BaseException:\n        if not rclpy.ok():\n            break", ""),
    ],
)
def test_a_loop_that_goes_on_after_ctrl_c(handler, words):
    said = " ".join(each["said"] for each in slips(LOOP.replace("EXCEPT", handler).encode()))
    assert words in said and bool(words) == bool(said)


def test_a_bare_except():
    assert "never ends" in slips(LOOP.replace("except EXCEPT", "except:\n        pass").encode())[0]["said"]


def test_a_default_that_grows():
    text = "def words(number, known=[]):\n    known += [number]\n    return known\n"
    assert "the default of known is made once" in slips(text.encode())[0]["said"]
    assert slips(text.replace("known +=", "known = known +").encode()) == []


SPINS = """\
rclpy.init()
node = Node("follower")
node.create_timer(0.1, lambda: node.get_logger().info("tick"))
SPIN
"""


@pytest.mark.parametrize(
    ("spin", "words"),
    [
        ("rclpy.spin(node)", ""),
        ("while rclpy.ok():\n    rclpy.spin_once(node)", ""),
        ("def turn():\n    rclpy.spin_once(node)\nwhile rclpy.ok():\n    turn()", ""),
        ("executor.spin()", ""),
        ("rclpy.spin_once(node)", "spin_once() waits for one event and returns"),
        ("rclpy.shutdown()", "nothing in this file spins the node"),
    ],
)
def test_a_program_that_spins_too_little(spin, words):
    said = " ".join(each["said"] for each in slips(SPINS.replace("SPIN", spin).encode()))
    assert words in said and bool(words) == bool(said)
