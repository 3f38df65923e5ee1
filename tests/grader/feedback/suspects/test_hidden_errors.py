"""Handlers that catch every error and show none."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
class Hit(Node):
    def on_scan(self, scan):
        try:
            hit = self.{inside}(scan)
            self.result.publish(hit)
        except {what}:
            {then}
"""


def hidden(what: str, then: str, inside: str = "find") -> list[str]:
    found = suspects(NODE.format(what=what, then=then, inside=inside).encode())
    return [f"{each['line']}: {each['said']}" for each in found if each["about"] == "hidden"]


@pytest.mark.parametrize("what", ["Exception", "BaseException", "builtins.Exception", "TypeError"])
@pytest.mark.parametrize("then", ["pass", "return", "error = None"])
def test_a_silent_handler_of_all_errors_is_found(what, then):
    words = f"6: except {what}: hides the errors of lines 4 to 5; take it away, and Python names the error"
    assert hidden(what, then) == [words]


def test_around_a_lookup_the_expected_error_is_proposed():
    assert "catch only what you expect, TransformException" in hidden("Exception", "pass", "lookup_transform")[0]


@pytest.mark.parametrize(
    ("what", "then", "inside"),
    [
        ("TransformException", "pass", "lookup_transform"),
        ("Exception as error", "self.get_logger().warning(str(error))", "find"),
        ("Exception", "raise", "find"),
        ("", "pass", "spin"),
    ],
)
def test_who_shows_the_error_or_names_it_is_none(what, then, inside):
    assert hidden(what, then, inside) == []
