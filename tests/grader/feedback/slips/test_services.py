"""A service whose callback forgets its answer is named before anybody calls it."""

import pytest

from gz_course.grader.feedback.slips import slips

RIGHT = """\
import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger


class Server(Node):
    def __init__(self):
        super().__init__("server")
        self.create_service(Trigger, "reset", self.on_reset)

    def on_reset(self, request, response):
        response.success = True
        return response


def main():
    rclpy.init()
    rclpy.spin(Server())


main()
"""


def said(text):
    return [(each["line"], each["said"]) for each in slips(text.encode()) if "answers a service" in each["said"]]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("        return response\n", ""),
        ("return response\n", "return\n"),
        ("return response\n", "return None\n"),
        ("return response\n", "self.done = lambda: response\n"),
        ('"reset", self.on_reset', '"reset", callback=self.on_reset'),
    ],
)
def test_a_callback_without_its_answer_is_named(old, new):
    text = RIGHT.replace(old, new)
    if "callback=" in new:
        text = text.replace("        return response\n", "")
    assert text != RIGHT
    ((line, words),) = said(text)
    assert line == 11 and "on_reset() answers a service" in words and "return response" in words


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        ("def on_reset", "async def on_reset"),
        ("        return response\n", "        raise NotImplementedError\n"),
        ("return response\n", "return self.answer(response)\n"),
    ],
)
def test_a_callback_with_one_is_not(old, new):
    assert said(RIGHT.replace(old, new)) == []
