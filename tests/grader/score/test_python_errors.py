"""Errors of Python and rclpy, as they really come, and what is said of them."""

import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import Float32, String

from gz_course.grader.score.python_errors import meaning


class Forgetful(Node):
    """Does everything a beginner does."""

    def __init__(self):
        self.create_timer(1.0, print)

    def no_self():
        pass

    def no_message(self):
        pass


@pytest.fixture(scope="module")
def node():
    context = rclpy.Context()
    context.init()
    node = rclpy.create_node("beginner", context=context)
    yield node
    node.destroy_node()
    context.shutdown()


MISTAKES = {
    "def no_self(self)": lambda node: Forgetful.no_self(node),
    "def no_message(self, message)": lambda node: Forgetful.no_message(node, node),
    "super().__init__('NODE_NAME') must come first in Forgetful.__init__": lambda node: Forgetful(),
    "as a method it is def on_message(self, message)": lambda node: node.create_subscription(
        String, "/a", lambda: None, 10
    ),
    "the order is create_publisher(TYPE, '/topic', 10)": lambda node: node.create_publisher("/a", String, 10),
    "with brackets, String(), it makes a message": lambda node: node.create_publisher(String, "/a", 1).publish(String),
    "make a String(), fill in its fields": lambda node: node.create_publisher(String, "/a", 1).publish("hello"),
    "such as a number where a text belongs": lambda node: node.create_publisher(String, "/a", 1).publish(
        String(data=4)
    ),
    "make a Float32(), fill in its fields": lambda node: node.create_publisher(Float32, "/b", 1).publish({"data": 1.0}),
    "takes its fields by their names": lambda node: Float32(1.0),
    "in ROS 2 a node imports rclpy": lambda node: __import__("rospy"),
    "from std_msgs.msg import String": lambda node: exec("from std_msgs import String"),
    "duration.nanoseconds / 1e9": lambda node: Duration(seconds=1).seconds,
    "time.nanoseconds / 1e9": lambda node: Time(seconds=1).to_sec(),
    "compare a Duration with a Duration": lambda node: Duration(seconds=1) < 5.0,
    "numbers and Times do not mix": lambda node: 5.0 - Time(seconds=1),
}


@pytest.mark.parametrize("words", MISTAKES)
def test_a_mistake_is_explained(node, words):
    with pytest.raises(Exception) as told:
        MISTAKES[words](node)
    assert words in meaning(f"{told.type.__name__}: {told.value}".splitlines()[0])


@pytest.mark.parametrize(
    "error",
    [
        "ZeroDivisionError: division by zero",
        "TypeError: 'int' object is not iterable",
        "TypeError: on_timer() takes 0 positional arguments but 1 was given",  # no method: it has no self
        "TypeError: Robot.drive() takes 2 positional arguments but 5 were given",
        "TypeError: Robot.__init__() takes 1 positional argument but 2 were given",
        "ModuleNotFoundError: No module named 'numpyy'",
        "",
    ],
)
def test_what_is_not_certain_is_not_explained(error):
    assert meaning(error) == ""
