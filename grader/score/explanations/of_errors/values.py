"""Right types with impossible values, fields of messages filled with what does not fit, parameters, recursion.

Source: the error texts of CPython 3.11, NumPy 2 and rclpy 7.1, and the type support of message classes in Python.
"""

from __future__ import annotations

import re

# Pattern of the error -> what to change. {0}, {1} are the groups of the pattern.
MEANINGS = (
    (
        re.compile(r"ZeroDivisionError: (?!0\.0 cannot)"),
        "the divisor is 0 here: of a list that may be empty, len() is asked first; time that has passed may be 0 in "
        "the "
        "first call",
    ),
    (
        re.compile(r"ValueError: math domain error|expected a (?:nonnegative|positive) input"),
        "the argument lies outside of the function: acos and asin take -1 to 1, sqrt no negative number, log no 0",
    ),
    (
        re.compile(r"cannot convert float (infinity|NaN) to integer"),
        "the value is {0}: a ray without an echo is infinite; keep values for which math.isfinite(value) holds",
    ),
    (
        re.compile(r"The truth value of an array with more than one element is ambiguous"),
        "if, and, or ask for one truth value, and a comparison of an array has one for each element: values[values "
        "> 1.0] "
        "selects, & and | (with brackets on both sides) combine two, .any() and .all() make one of them",
    ),
    (
        re.compile(r"operands could not be broadcast together with shapes (\(.*?\)) (\(.*?\))"),
        "two arrays of different lengths, {0} and {1}, cannot be reckoned with element by element",
    ),
    (
        re.compile(r"only (?:length-1|size-1|0-dimensional) arrays can be converted"),
        "a function of math, or float(), got a whole array: np.sin, np.cos and np.sqrt work element by element",
    ),
    (
        re.compile(r"could not convert string to float"),
        "that text is no number as Python writes it: digits with a point, '0.5'",
    ),
    (
        re.compile(r"RecursionError"),
        "a function calls itself without end: self.publish(...) inside of def publish is the function itself, not the "
        "publisher's",
    ),
    (
        re.compile(r"AttributeError: 'property' object has no attribute"),
        "that is the class of the message: with brackets, as in command = Twist(), it makes one whose fields can be "
        "set",
    ),
    (
        re.compile(r"AttributeError: 'float' object has no attribute '(?:sec|nanosec)'"),
        "a stamp is no number: header.stamp = self.get_clock().now().to_msg()",
    ),
    (
        re.compile(r"AttributeError: '(?:tuple|list|array|ndarray)' object has no attribute '([xyzw])'"),
        "a vector of a message is no list: its fields are set one by one, as in point.{0} = 1.0, or by Point(x=1.0)",
    ),
    (
        re.compile(r"'float' object cannot be interpreted as an integer"),
        "a whole number belongs here: int(value) makes one, // divides without a remainder",
    ),
    (
        re.compile(r"(?:signed char|unsigned byte|byte) .*(?:greater|less) than|out of range for"),
        "the value does not fit into the field: an OccupancyGrid holds -1 and 0 to 100",
    ),
    (
        re.compile(r"only integer scalar arrays can be converted to a scalar index"),
        "the field takes a flat list of whole numbers: grid.flatten().tolist()",
    ),
    (
        re.compile(r"Can't (?:subtract|compare) times with different clock types"),
        "one of the two is of another clock: Time() without clock_type is system time; Time.from_msg(stamp, "
        "clock_type=self.get_clock().clock_type), or nanoseconds of both, can be reckoned with",
    ),
    (
        re.compile(r"ParameterNotDeclaredException.*: (\S+)$"),
        "before it is read it is declared: self.declare_parameter('{0}', DEFAULT)",
    ),
    (
        re.compile(r"ParameterAlreadyDeclaredException"),
        "declare_parameter is called once, in __init__; get_parameter('NAME').value reads it",
    ),
    (
        re.compile(r"'Parameter' object has no attribute '(\w+)'"),
        "the value of a parameter is its .value: self.get_parameter('NAME').value",
    ),
    (
        re.compile(r"type object '(\w+)' has no attribute '_TYPE_SUPPORT'"),
        "a message class stands first, such as create_publisher(Twist, '/topic', 10); this is of type {0}",
    ),
    (
        re.compile(
            r"'(str|int|Timer|Publisher|Subscription|NoneType)' object has no attribute "
            r"'(?:executor|subscriptions)'"
        ),
        "rclpy.spin() takes a node, and got something else ({0}): node = MyNode(), then rclpy.spin(node)",
    ),
    (
        re.compile(r"TypeError: object\.__init__\(\) takes exactly one argument"),
        "the class has no base that takes a name: class MyNode(Node):, and super().__init__('NODE_NAME')",
    ),
    (
        re.compile(r"TypeError: (Duration|Time)\.__init__\(\) takes 1 positional argument"),
        "the unit is given by its name: {0}(seconds=5.0)",
    ),
    (
        re.compile(r"TypeError: QoSProfile\.__init__\(\) takes 1 positional|InvalidQoSProfileException"),
        "the depth is given by its name: QoSProfile(depth=10)",
    ),
    (
        re.compile(r"TypeError: Expected <class '[\w.]+\.(\w+)'>, got <class '[\w.]+\._\w+\.(\w+)'>"),
        "this publisher was made for messages of type {0}, and a {1} is handed to it",
    ),
    (
        re.compile(r"history depth must be"),
        "the last argument is the depth of the queue: 0 or more, such as 10",
    ),
    (
        re.compile(r"'NoneType' object has no attribute 'successful'"),
        "the callback of add_on_set_parameters_callback must return SetParametersResult(successful=True)",
    ),
    (
        re.compile(r"(?:Expected|got) <class 'NoneType'>|got <class 'NoneType'>"),
        "nothing was returned or handed over where a message belongs: the callback of a service ends with return "
        "response",
    ),
    (
        re.compile(r"no running event loop"),
        "asyncio has an event loop of its own, which rclpy does not run: a timer, or the sleep() of a Rate in another "
        "thread, waits",
    ),
    (
        re.compile(r"'(?:Server)?GoalHandle' object has no attribute 'set_(succeeded|aborted|canceled)'"),
        "set_{0} is of ROS 1; a goal handle has succeed(), abort() and canceled(), and execute returns the result",
    ),
    (
        re.compile(r"timer period must be non-negative"),
        "the period of a timer is a number of seconds, 0 or more",
    ),
    (
        re.compile(r"AttributeError: 'Future' object has no attribute '(\w+)'"),
        "a Future is no answer yet: when it is done(), .result() is the answer, .result().{0} its field",
    ),
    (
        re.compile(r"AttributeError: 'Duration' object has no attribute '(\w+)'"),
        "a Duration has .nanoseconds: divided by 1e9 these are seconds",
    ),
    (
        re.compile(r"object (\w+) can't be used in 'await' expression"),
        "await waits for a Future; a {0} is there already",
    ),
    (
        re.compile(r"KeyError: (.+)$"),
        "the dictionary has no entry {0}: dictionary.get(key) returns None then",
    ),
    (
        re.compile(r"ModuleNotFoundError: No module named '(scipy|cv2|pandas|matplotlib|sklearn|torch|gazebo_msgs)\b"),
        "{0} is not part of the course: Python, NumPy and the packages of ROS are",
    ),
    (
        re.compile(r"AttributeError: '(?:Teleop|\w+)' object has no attribute '_parameter_overrides'"),
        "super().__init__('NODE_NAME') must come first in __init__: it makes the node",
    ),
)


def impossible(error: str, code: str) -> str:
    """Explain a value that a function or a field cannot take."""
    for pattern, words in MEANINGS:
        if match := pattern.search(error):
            return words.format(*match.groups())
    return ""
