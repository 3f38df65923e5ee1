"""Errors of Python and rclpy, as they really come, and what is said of them."""

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String

from gz_course.grader.feedback.errors.python_errors import meaning
from gz_course.sim.ros.tf2_py import BufferCore


class Forgetful(Node):
    """Does everything a beginner does."""

    def __init__(self):
        self.create_timer(1.0, print)

    def no_self():
        pass

    def no_message(self):
        pass


class Handed:
    def no_message(self, message):
        pass

    def on_goal(self, handle, goal):
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
    "Catch TransformException": lambda node: BufferCore().lookup_transform_core("odom", "lidar", Time()),
    "do not begin with a slash": lambda node: BufferCore().lookup_transform_core("/odom", "lidar", Time()),
    "in ROS 2 a node imports rclpy": lambda node: __import__("rospy"),
    "from std_msgs.msg import String": lambda node: exec("from std_msgs import String"),
    "duration.nanoseconds / 1e9": lambda node: Duration(seconds=1).seconds,
    "time.nanoseconds / 1e9": lambda node: Time(seconds=1).to_sec(),
    "compare a Duration with a Duration": lambda node: Duration(seconds=1) < 5.0,
    "numbers and Times do not mix": lambda node: 5.0 - Time(seconds=1),
    "the start has not been set": lambda node: Time(seconds=1) - None,
    "the depth of the queue, is missing": lambda node: node.create_subscription(String, "/a", print),
    "the last one is the depth, a number": lambda node: node.create_subscription(String, "/a", 10, print),
    "what follows the depth is given by its name": lambda node: node.create_subscription(String, "/a", print, 10, None),
    "create_timer(PERIOD in seconds, callback)": lambda node: node.create_timer(print, 1.0),
    "def no_message(self, message) one for a subscription": lambda node: Handed().no_message(),
    "goal_callback with the goal and the others with the goal handle": lambda node: Handed().on_goal(1),
    "rclpy.spin(node)": lambda node: rclpy.spin(),
    "spin_once(node, timeout_sec=0.1)": lambda node: rclpy.spin_once(node, 0.1),
    "from rclpy.node import Node": lambda node: rclpy.Node,
    "belongs to a node: self.create_publisher": lambda node: rclpy.create_publisher,
    "the field of a LaserScan is called ranges": lambda node: LaserScan().range,
    "a Twist has the fields linear, angular": lambda node: Twist().x,
    "the field of a Float32 is called data": lambda node: Float32().value,
    "the package is called std_msgs": lambda node: __import__("std_msg.msg"),
    "capitals count": lambda node: exec("from sensor_msgs.msg import Laserscan"),
    "passed without brackets": lambda node: eval("nothing()", {"nothing": None}),
    "as in self.get_logger().info": lambda node: node.get_logger.info("x"),
    "stamp.sec + stamp.nanosec / 1e9": lambda node: LaserScan().header.stamp.nanoseconds,
    "the condition has kept no value": lambda node: min([]),
    "a number becomes a part of a text": lambda node: "speed " + 1.0,
    "reached with self.publisher": lambda node: eval("publisher"),
    "the import of Twist is missing": lambda node: eval("Twist", {}),
    "self.start is not set when it is used": lambda node: Handed().start,
    "spelt": lambda node: Handed().publishr,
    "names consist of letters": lambda node: node.create_publisher(String, "/a b", 10),
    "must come first": lambda node: Forgetful(),
}


@pytest.mark.parametrize("words", MISTAKES)
def test_a_mistake_is_explained(node, words):
    with pytest.raises(Exception) as told:
        MISTAKES[words](node)
    assert words in meaning(f"{told.type.__name__}: {told.value}".splitlines()[0])


# Error, the line that raised it -> what is said.
ERRORS = {
    (
        "TypeError: 'NoneType' object does not support the context manager protocol",
        "with rclpy.init():",
    ): "returns None on Jazzy",
    (
        "TypeError: Talker.stop() takes 1 positional argument but 2 were given",
        "self.stop(now)",
    ): "def stop takes 0 argum",
    (
        "TypeError: Talker.move() missing 1 required positional argument: 'v'",
        "self.move()",
    ): "passes no value for it",
    ("TypeError: Talker.move() missing 1 required positional argument: 'v'", ""): "a timer calls its callback without",
    ("TypeError: Node.get_logger() takes 1 positional argument but 2 were given", ""): "get_logger() without arguments",
    ("TypeError: RcutilsLogger.info() takes 2 positional arguments but 3 were given", ""): "one text: f'speed",
    ("TypeError: Node.__init__() takes 2 positional arguments but 3 were given", ""): "takes the name only",
    ("TypeError: Node.__init__() got an unexpected keyword argument 'use_sim_time'", ""): "comes from outside",
    (
        "TypeError: Node.__init__() missing 1 required positional argument: 'node_name'",
        'Node.__init__("a")',
    ): "on the class",
    ("AttributeError: 'Talker' object has no attribute 'now'", "now = self.now()"): "there is self.get_clock().now()",
    (
        "AttributeError: 'Talker' object has no attribute 'create_subscriber'",
        "self.create_subscriber(a)",
    ): "create_subsc",
    ("AttributeError: property 'publishers' of 'Talker' object has no setter", "self.publishers = []"): "another name",
    ("AttributeError: module 'rclpy' has no attribute 'init_node'", "rclpy.init_node('a')"): "rclpy.init() and then",
    ("AttributeError: module 'std_msgs.msg' has no attribute 'Twist'", ""): "from geometry_msgs.msg import Twist",
    ("ImportError: cannot import name 'Twist' from 'std_msgs.msg'", ""): "from geometry_msgs.msg import Twist",
    ("ModuleNotFoundError: No module named 'Twist'", "import Twist"): "from geometry_msgs.msg import Twist",
    ("NameError: name 'time' is not defined", "x = time.time()"): "import time",
    ("NameError: name 'true' is not defined", "x = true"): "Python writes it True",
    ("NameError: name 'TeleopNode' is not defined", "rclpy.spin(TeleopNode())"): "no class TeleopNode",
    ("NameError: name 'tick' is not defined", "self.create_timer(0.1, tick)"): "passed as self.tick",
    ("TypeError: unsupported operand type(s) for -: 'Time' and 'Time'", "now - msg.header.stamp"): "Time.from_msg",
    ("TypeError: unsupported operand type(s) for /: 'Duration' and 'float'", "d / 1e9"): "nanoseconds / 1e9",
    ("TypeError: unsupported operand type(s) for *: 'Parameter' and 'int'", "p * 2"): "is its .value",
    ("TypeError: unsupported operand type(s) for *: 'Float32' and 'int'", "m * 2"): ".data is the value",
    ("TypeError: '<' not supported between instances of 'int' and 'str'", "a < b"): "float(text) makes a number",
    ("TypeError: '<' not supported between instances of 'array.array' and 'float'", "r < 1.0"): "take one element",
    ("TypeError: '>' not supported between instances of 'tuple' and 'int'", "t > 5"): "take one element",
    ("TypeError: 'LaserScan' object is not iterable", "min(scan)"): "in its field ranges",
    ("TypeError: 'float' object is not iterable", "min(scan.range_min)"): "take the whole list",
    ("TypeError: array indices must be integers", "r[len(r) / 2]"): "// divides without",
    ("IndexError: array index out of range", "r[360]"): "the last is len(...) - 1",
    ("AttributeError: 'array.array' object has no attribute 'min'", "r.min()"): "min(values)",
    ("TypeError: 'bool' object is not callable", "self.stop()"): "a variable has taken the name of a function",
    ("ValueError: math domain error", "math.acos(2)"): "acos and asin take -1 to 1",
    ("AttributeError: 'property' object has no attribute 'x'", "Twist.linear.x = 1.0"): "with brackets",
    ("AttributeError: 'float' object has no attribute 'sec'", ""): ".now().to_msg()",
    ("TypeError: object.__init__() takes exactly one argument (the instance to initialize)", ""): "class MyNode(Node)",
    ("TypeError: Duration.__init__() takes 1 positional argument but 2 were given", ""): "Duration(seconds=5.0)",
    ("TypeError: Duration.__init__() got an unexpected keyword argument 'sec'", ""): "Duration(seconds=5.0)",
    ("AttributeError: 'Odometry' object has no attribute 'position'", ""): "position is in .pose.pose.position",
    ("AttributeError: 'NoneType' object has no attribute 'ranges'", "min(self.scan.ranges)"): "no message has come",
    ("f.py, line 3: SyntaxError: expected ':': else if b:", ""): "elif CONDITION",
    ("f.py, line 3: SyntaxError: invalid syntax: if a && b:", ""): "and, or and not",
    ("f.py, line 3: SyntaxError: invalid syntax: n++", ""): "x += 1",
    ("f.py, line 3: SyntaxError: invalid decimal literal: x = 5s", ""): "no units",
    ("f.py, line 3: SyntaxError: f-string: unmatched '[': x = f'{a['b']}'", ""): "the other kind of quotes",
}


@pytest.mark.parametrize("error", ERRORS)
def test_an_error_in_a_line_is_explained(error):
    assert ERRORS[error] in meaning(*error)


@pytest.mark.parametrize(
    "error",
    [
        "ValueError: no robot",
        "TypeError: 'Robot' object is not iterable",
        "TypeError: on_timer() takes 0 positional arguments but 1 was given",  # no method: it has no self
        "TypeError: Robot.drive() takes 2 positional arguments but 5 were given",
        "TypeError: Robot.__init__() takes 1 positional argument but 2 were given",
        "ModuleNotFoundError: No module named 'numpyy'",
        "",
    ],
)
def test_what_is_not_certain_is_not_explained(error):
    assert meaning(error) == ""
