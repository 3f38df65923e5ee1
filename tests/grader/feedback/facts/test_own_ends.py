"""The line that ends a program by itself, and programs that run until Ctrl-C."""

import pytest

from gz_course.grader.feedback.facts.own_ends import own_ends

NODE = """\
class Driver(Node):
    def drive(self):
        self.publisher.publish(Twist())
        PARKED


def main():
    rclpy.init()
    node = Driver()
    try:
        SPIN
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()
"""
SPIN = "rclpy.spin(node)"


@pytest.mark.parametrize(
    ("parked", "spin", "words"),
    [
        ("raise SystemExit", SPIN, "`raise SystemExit` in drive() ends the program"),
        ("raise SystemExit(0)", SPIN, "`raise SystemExit(0)` in drive()"),
        ("sys.exit()", SPIN, "`sys.exit()` in drive()"),
        ("rclpy.shutdown()", SPIN, "`rclpy.shutdown()` in drive()"),
        ("self.context.try_shutdown()", SPIN, "`self.context.try_shutdown()`"),
        ("self.done.set_result(True)", "rclpy.spin_until_future_complete(node, node.done)", "until the future is done"),
        ("pass", "while not node.parked: rclpy.spin_once(node)", "`while not node.parked` ends"),
        ("pass", "while rclpy.ok():\n            if node.a: break\n            rclpy.spin_once(node)", "this break"),
        ("pass", "for _ in range(200): rclpy.spin_once(node)", "this loop ends"),
        ("pass", SPIN, ""),
        ("pass", "while rclpy.ok(): rclpy.spin_once(node)", ""),
        ("self.executor.wake()", "while True:\n            rclpy.spin_once(node)", ""),
        ("pass", "rclpy.spin_until_future_complete(node, node.ready)\n        rclpy.spin(node)", ""),
    ],
)
def test_what_ends_a_program(parked, spin, words):
    found = own_ends(NODE.replace("PARKED", parked).replace("SPIN", spin).encode())
    assert bool(found) == bool(words)
    assert not words or words in found[0]["said"]
