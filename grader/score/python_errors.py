"""Explanations for errors of Python and rclpy whose own text does not say what to change; used by `diagnosis.py`.

Only errors with a certain cause are listed: a wrong guess is worse than none.
"""

from __future__ import annotations

import re

# Pattern of the error's first line -> what to change. {0}, {1} are the groups of the pattern.
MEANINGS = (
    (
        re.compile(r"TypeError: \w+\.(?!__)(\w+)\(\) takes 0 positional arguments but 1 was given"),
        "a method gets the object itself as its first argument: def {0}(self)",
    ),
    (
        re.compile(r"TypeError: \w+\.(?!__)(\w+)\(\) takes 1 positional argument but 2 were given"),
        "a method gets the object itself and then what it is called with, a callback its message: "
        "def {0}(self, message)",
    ),
    (
        re.compile(
            r"TypeError: (String|Bool|Float\d+|U?Int\d+|Twist|Vector3|Point|Quaternion|Header)\.__init__\(\) takes 1 "
            r"positional argument but \d+ were given"
        ),
        "a message takes its fields by their names, as String(data='...') does",
    ),
    (
        re.compile(
            r"AttributeError: '(\w+)' object has no attribute '_(?:default_callback_group|logger|clock|parameters)'"
        ),
        "super().__init__('NODE_NAME') must come first in {0}.__init__: it makes the node",
    ),
    (
        re.compile(r"RuntimeError: Subscription\.__init__\(\): callback should be"),
        "the callback of a subscription is called with the message; as a method it is def on_message(self, message)",
    ),
    (
        re.compile(r"TypeError: rclpy_resolve_name\(\): incompatible function arguments"),
        "the order is create_publisher(TYPE, '/topic', 10) and create_subscription(TYPE, '/topic', callback, 10)",
    ),
    (
        re.compile(r"TypeError: Expected <class '[\w.]+'>, got <class '[\w.]+\.Metaclass_(\w+)'>"),
        "that is the class: with brackets, {0}(), it makes a message",
    ),
    (
        re.compile(
            r"TypeError: Expected <class '[\w.]+\.(\w+)'>, got <class '(?:str|int|float|bool|list|dict|tuple)'>"
        ),
        "publish() sends messages only: make a {0}(), fill in its fields, and publish that",
    ),
    (
        re.compile(r"ModuleNotFoundError: No module named '(?:rospy|roslib|tf|actionlib)'"),
        "that belongs to ROS 1; in ROS 2 a node imports rclpy",
    ),
    (
        re.compile(r"ImportError: cannot import name '(\w+)' from '(\w+_msgs)'"),
        "message types are in the module {1}.msg: from {1}.msg import {0}",
    ),
    (
        re.compile(r"AttributeError: 'Duration' object has no attribute '(?:seconds|secs|sec|to_sec|total_seconds)'"),
        "in seconds it is duration.nanoseconds / 1e9",
    ),
    (
        re.compile(r"AttributeError: 'Time' object has no attribute '(?:seconds|secs|sec|to_sec|nanosec)'"),
        "in seconds it is time.nanoseconds / 1e9; seconds_nanoseconds() gives both parts",
    ),
    (
        re.compile(r"TypeError: '[<>]=?' not supported between instances of '(?:Duration|int|float)' and '(\w+)'"),
        "compare a Duration with a Duration, Duration(seconds=5.0) of rclpy.duration, or its .nanoseconds / 1e9 with a "
        "number",
    ),
    (
        re.compile(r"TypeError: unsupported operand type\(s\) for [-+]: '(?:float|int|Time)' and '(?:float|int|Time)'"),
        "a Time minus a Time is a Duration, whose .nanoseconds / 1e9 are seconds; numbers and Times do not mix",
    ),
    (
        re.compile(r"TypeError: bad argument type for built-in operation"),
        "a field of the message holds a value of another type, such as a number where a text belongs: str(value)",
    ),
    (
        re.compile(r"TypeError: 'property' object is not iterable"),
        "rclpy.spin() takes a node, not its class: with brackets, MyNode(), it is one",
    ),
    (re.compile(r"RuntimeError: Context\.init\(\) must only be called once"), "call rclpy.init() once, at the start"),
    (re.compile(r"EOFError: EOF when reading a line"), "there is no keyboard here: do not call input()"),
)


def meaning(error: str) -> str:
    """Return what to change, given the first line of an error as Python prints it; empty if unknown."""
    for pattern, words in MEANINGS:
        if match := pattern.search(error):
            return words.format(*match.groups())
    return ""
