"""A publisher that nothing uses, and one that is made in a callback."""

import pytest

from gz_course.grader.feedback.slips import slips

TEXT = """\
class Greeter(Node):
    def __init__(self):
        super().__init__("greeter")
        {init}
        self.create_timer(1.0, self.greet)

    def greet(self):
        {first}
        {second}
"""
MADE = 'self.p = self.create_publisher(String, "/hello", 10)'


@pytest.mark.parametrize(
    ("init", "first", "second", "words"),
    [
        (MADE, "message = String()", "self.get_logger().info(message.data)", "nothing in the file calls its publish()"),
        ("pass", MADE, "self.p.publish(String())", "greet makes the publisher and publishes at once"),
        (MADE, "message = String()", "self.p.publish(message)", ""),
        ("pass", f"if self.p is None: {MADE}", "self.p.publish(String())", ""),
        (MADE, "message = String()", "self.send(self.p.publish, message)", ""),
    ],
)
def test_publishers(init, first, second, words):
    found = [place["said"] for place in slips(TEXT.format(init=init, first=first, second=second).encode())]
    assert words in "\n".join(found) and bool(found) == bool(words)
