"""Right types with impossible values, fields of messages filled with what does not fit, parameters, recursion.

Source: the error texts of CPython 3.11, NumPy 2 and rclpy 7.1, and the type support of message classes in Python.
"""

from __future__ import annotations

from gz_course.grader.feedback.errors import explanation, listed, table

BEFORE = ("python_errors",)

# Pattern of the error -> what to change. {0}, {1} are the groups of the pattern.
MEANINGS = table(r"""
ZeroDivisionError: (?!0\.0 cannot)
    the divisor is 0 here: of a list that may be empty, len() is asked first; time that has passed may be 0 in the first
    call
ValueError: math domain error|expected a (?:nonnegative|positive) input
    the argument lies outside of the function: acos and asin take -1 to 1, sqrt no negative number, log no 0
could not convert string to float
    that text is no number as Python writes it: digits with a point, '0.5'
RecursionError
    a function calls itself without end: self.publish(...) inside of def publish is the function itself, not the
    publisher's
AttributeError: 'property' object has no attribute
    that is the class of the message: with brackets, as in command = Twist(), it makes one whose fields can be set
AttributeError: 'float' object has no attribute '(?:sec|nanosec)'
    a stamp is no number: header.stamp = self.get_clock().now().to_msg()
AttributeError: '(?:tuple|list|array|ndarray)' object has no attribute '([xyzw])'
    a vector of a message is no list: its fields are set one by one, as in point.{0} = 1.0, or by Point(x=1.0)
Can't (?:subtract|compare) times with different clock types
    one of the two is of another clock: Time() without clock_type is system time; Time.from_msg(stamp,
    clock_type=self.get_clock().clock_type), or nanoseconds of both, can be used together
'Parameter' object has no attribute '(\w+)'
    the value of a parameter is its .value: self.get_parameter('NAME').value
type object '(\w+)' has no attribute '_TYPE_SUPPORT'
    a message class stands first, such as create_publisher(Twist, '/topic', 10); this is of type {0}
'(str|int|Timer|Publisher|Subscription|NoneType)' object has no attribute '(?:executor|subscriptions)'
    rclpy.spin() takes a node, and got something else ({0}): node = MyNode(), then rclpy.spin(node)
TypeError: object\.__init__\(\) takes exactly one argument
    the class has no base that takes a name: class MyNode(Node):, and super().__init__('NODE_NAME')
'(str|int|dict)' object has no attribute '(?:sec|nanosec)'
    a stamp in the message is of type {0}, and must be a time: copy header.stamp of another message, or take
    self.get_clock().now().to_msg()
InvalidQoSProfileException
    a QoSProfile needs a depth, and the depth is given by its name: QoSProfile(depth=10)
TypeError: Expected <class '[\w.]+\.(\w+)'>, got <class '[\w.]+\._\w+\.(?!Metaclass_)(\w+)'>
    this publisher was made for messages of type {0}, and a {1} is handed to it
history depth must be
    the last argument is the depth of the queue: 0 or more, such as 10
'NoneType' object has no attribute 'successful'
    the callback of add_on_set_parameters_callback must return SetParametersResult(successful=True)
(?:Expected|got) <class 'NoneType'>|got <class 'NoneType'>
    nothing was returned or passed where a message belongs: the callback of a service ends with return response
timer period must be non-negative
    the period of a timer is a number of seconds, 0 or more
AttributeError: 'Future' object has no attribute '(\w+)'
    a Future is no answer yet: when it is done(), .result() is the answer, .result().{0} its field
KeyError: (.+)$
    the dictionary has no entry {0}: dictionary.get(key) returns None then
ModuleNotFoundError: No module named '(scipy|cv2|pandas|matplotlib|sklearn|torch|gazebo_msgs)\b
    {0} is not part of the course: Python, NumPy and the packages of ROS are
""")


@explanation
def value_error(error: str, code: str) -> str:
    return listed(error, MEANINGS)
