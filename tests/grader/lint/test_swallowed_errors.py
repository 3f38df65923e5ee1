"""Handlers that catch every error and show none."""

import pytest

from gz_course.grader.lint.swallowed_errors import swallowed_errors

NODE = """\
class Hit(Node):
    def on_scan(self, scan):
        try:
            self.result.publish(self.find(scan))
        except {what}:
            {then}
"""


@pytest.mark.parametrize("what", ["Exception", "BaseException", "Exception as error", "builtins.Exception"])
@pytest.mark.parametrize("then", ["pass", "return", "error = None"])
def test_a_silent_handler_of_all_errors_is_found(what, then):
    found = swallowed_errors(NODE.format(what=what, then=then).encode())
    assert found == [{"line": 5, "first": 4, "last": 4}]


@pytest.mark.parametrize(
    ("what", "then"),
    [
        ("TransformException", "pass"),
        ("Exception as error", "self.get_logger().warning(str(error))"),
        ("Exception", "raise"),
    ],
)
def test_who_shows_the_error_or_names_it_is_none(what, then):
    assert swallowed_errors(NODE.format(what=what, then=then).encode()) == []


def test_a_handler_around_spin_is_none():
    assert swallowed_errors(b"try:\n    node.publish()\n    rclpy.spin(node)\nexcept:\n    pass\n") == []
