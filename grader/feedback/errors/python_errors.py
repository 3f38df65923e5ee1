"""Explanations for errors of Python and rclpy whose own text does not say what to change; for `diagnosis.py`.

Source: the error texts of CPython 3.11, NumPy 2 and rclpy 7.1, and the type support of message classes in Python.

Only errors with a certain cause are listed: a wrong guess is worse than none.
"""

from __future__ import annotations

from gz_course.grader.feedback.errors import ROOM, explanation, listed, table
from gz_course.grader.feedback.rules import ask

# Pattern of the error -> what to change. {0}, {1} are the groups of the pattern.
VALUES = table(r"""
ZeroDivisionError: (?!0\.0 cannot)
    the divisor is 0 here: of a list that may be empty, len() is asked first; time that has passed may be 0 in the first
    call
ValueError: math domain error|expected a (?:nonnegative|positive) input
    the argument lies outside of the function: acos and asin take -1 to 1, sqrt no negative number, log no 0
could not convert string to float
    that text is no number as Python writes it: digits with a point, '0.5'
ValueError: no signature found for builtin
    rclpy asks a callback for its parameters, and this method of Python's own names none: write a function, or a lambda,
    that calls it
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
ModuleNotFoundError: No module named '(scipy|cv2)\b
    {0} is not installed here: pip install 'gz-ros2-course[chapters]' installs it
ModuleNotFoundError: No module named '(pandas|matplotlib|sklearn|torch|gazebo_msgs)\b
    {0} is not part of the course: Python, NumPy, SciPy, OpenCV and the packages of ROS are
""")
# Pattern of the error's first line -> what to change. {0}, {1} are the groups of the pattern.
MEANINGS = table(r"""
TypeError: \w+\.(?!__)(\w+)\(\) takes 0 positional arguments but 1 was given
    a method gets the object itself as its first argument: def {0}(self)
TypeError: (?!Node\b)\w+\.(?!__)(\w+)\(\) takes 1 positional argument but 2 were given
    a method gets the object itself and then what it is called with, a callback its message: def {0}(self, message)
TypeError: (String|Bool|Float\d+|U?Int\d+|Twist|Vector3|Point|Quaternion|
Header)\.__init__\(\) takes 1 positional argument but \d+ were given
    a message takes its fields by their names, as String(data='...') does
AttributeError: '(?:float|int|str)' object has no attribute '([xyz])'
    a number is given where a vector is needed: linear and angular of a Twist have the fields x, y and z, as in
    command.linear.{0} = 0.5
AttributeError: 'Subscription' object has no attribute 'publish'
    a subscription only receives messages; create_publisher(TYPE, '/topic', 10) makes what publishes
AttributeError: 'Publisher' object has no attribute '(\w+)'
    a publisher has publish(message) and no {0}; what is received comes to the callback of a subscription
TypeError: descriptor '__init__' requires a 'super' object
    brackets are missing after super: super().__init__('NODE_NAME')
AttributeError: '(\w+)' object has no attribute '_(?:default_callback_group|logger|clock|parameters|
parameter_overrides|Node__\w+)'
    super().__init__('NODE_NAME') must come first in {0}.__init__: it makes the node
RuntimeError: Subscription\.__init__\(\): callback should be
    the callback of a subscription is called with the message; as a method it is def on_message(self, message)
TypeError: rclpy_resolve_name\(\): incompatible function arguments
    the order is create_publisher(TYPE, '/topic', 10) and create_subscription(TYPE, '/topic', callback, 10)
TypeError: Expected <class '[\w.]+'>, got <class '[\w.]+\.Metaclass_(\w+)'>
    that is the class: with brackets, {0}(), it makes a message
TypeError: Expected <class '[\w.]+\.(\w+)'>, got <class '(?:str|int|float|bool|list|dict|tuple)'>
    publish() sends messages only: make a {0}(), fill in its fields, and publish that
ImportError: cannot import name '(\w+)' from '(\w+_msgs)'
    message types are in the module {1}.msg: from {1}.msg import {0}
AttributeError: 'Duration' object has no attribute
    in seconds it is duration.nanoseconds / 1e9
AttributeError: 'Time' object has no attribute '(?:seconds|secs|sec|to_sec|nanosec)'
    in seconds it is time.nanoseconds / 1e9; seconds_nanoseconds() gives both parts
TypeError: bad argument type for built-in operation
    a field of the message holds a value of another type, such as a number where a text belongs: str(value)
TypeError: 'property' object is not iterable
    rclpy.spin() takes a node, not its class: with brackets, MyNode(), it is one
\b(?:Lookup|Extrapolation)Exception
    that transform is not there (yet): nodes hear transforms later than the first data. Catch TransformException of
    tf2_ros, and skip the message or keep it and try again
\bConnectivityException
    no transform connects the two frames (yet): ros2 run tf2_tools view_frames draws which are connected
\bInvalidArgumentException: Invalid argument .* passed to
    frame names are not empty and do not begin with a slash
RCLError: .*(?:context is invalid|context is not valid)|InvalidHandle|cannot use Destroyable
    rclpy.shutdown(), or destroy_node(), was called before: nothing can be published or read after it
^MemoryError
    more memory was asked for than there is: a list, an array or a text is far longer than it was meant to be
NotInitializedException
    rclpy.init() must be called before the first node is made
TypeError: Node\.create_(?:subscription|publisher)\(\) missing 1 required .*'qos_profile'
    the last argument, the depth of the queue, is missing, such as 10
TypeError: Expected QoSProfile or int, but received
    the order is create_publisher(TYPE, '/topic', 10) and create_subscription(TYPE, '/topic', callback, 10); the last
    one is the depth, a number, and further arguments are given by their names
TypeError: Node\.create_(subscription|publisher)\(\) takes \d+ positional arguments but \d+ were
    what follows the depth is given by its name, as callback_group=... is
TypeError: Node\.create_timer\(\) missing|TypeError: float\(\) argument must be .* not '\w*(?:function|method)'
    the order is create_timer(PERIOD in seconds, callback)
TypeError: (?:\w+\.)?(\w+)\(\) missing 1 required positional argument: 'self'
    {0} is called on the class, not on an object: self.{0}() inside of the class
TypeError: \w+\.((?!__|create_)\w*(?:goal|cancel|accepted|execute)\w*)\(\) missing 1 required positional argumen
t: '(?!self')\w+'
    an action server calls each of its callbacks with one argument beside self, goal_callback with the goal and the
    others with the goal handle: {0} asks for more
TypeError: (?!Node\b|Publisher\b)\w+\.(?!__|create_|info|log)(\w+)\(\) missing 1 required positional argument: '(\w+)'
    a timer calls its callback without arguments, a subscription with the message: def {0}(self) is one for a timer, def
    {0}(self, {1}) one for a subscription
TypeError: spin_once\(\) takes 1 positional argument
    the time is given by its name: spin_once(node, timeout_sec=0.1)
RuntimeError: Executor is already spinning|ValueError: generator already executing
    a callback is called by spin(); inside of it the node must not be spun again
ImportError: cannot import name 'Node' from 'rclpy'|No module named 'rclpy\.Node'|
module 'rclpy' has no attribute 'Node'
    the class is in the module rclpy.node: from rclpy.node import Node
AttributeError: module 'rclpy' has no attribute '(create_\w+|get_\w+)'
    {0} belongs to a node: self.{0}(...) inside of its class
ModuleNotFoundError: No module named '(std|sensor|geometry|nav)_msg(?:\.msg)?'
    the package is called {0}_msgs: from {0}_msgs.msg import ...
ModuleNotFoundError: No module named '(\w+_msgs)\.(?!msg')\w+'
    message types are in the module {0}.msg
ImportError: cannot import name '(\w+)' from '(\w+_msgs\.msg)'
    {1} has no message of that name; capitals count, as in LaserScan, and ros2 interface package lists the names
AttributeError: '(?:function|method|builtin_function_or_method)' object has no attribute '(\w+)'
    brackets are missing: what stands before .{0} must be called, as in self.get_logger().info(...)
AttributeError: 'Time' object has no attribute 'nanoseconds'
    the stamp of a message has sec and nanosec; in seconds it is stamp.sec + stamp.nanosec / 1e9, and
    rclpy.time.Time.from_msg(stamp) makes a Time of it
'NoneType' object has no attribute '(\w+)'
    what stands before .{0} is None: it was never set, or not yet (no message has come), or it is the result of a
    function that returns nothing
ValueError: (min|max)\(\) (?:iterable argument|arg) is (?:an )?empty|
ValueError: zero-size array to reduction operation (min|max)
    the list is empty: the condition has kept no value at all
TypeError: 'Metaclass_(\w+)' object|TypeError: 'property' object is not subscriptable
    that is the class of the message; the message itself is the callback's argument
InvalidTopicNameException|InvalidNodeNameException
    names consist of letters, digits and _, topics also of /; there are no spaces or hyphens in them
UnboundLocalError: .*variable '(min|max|sum|len|abs|round|list|range|sorted|float|int|str|any|all)'
    the function assigns to {0}, so {0} is its own variable everywhere in it, and Python's {0}() is hidden: call the
    variable something else
UnboundLocalError: .*variable '(\w+)'
    a function that assigns to {0} has a {0} of its own; what is to last is kept as self.{0}
NameError: name 'self' is not defined
    the method has no parameter self, or the line stands outside of a method
AttributeError: '(?!(?:Twist|LaserScan|String|Float\d+|Odometry|Vector3|Header|Subscription|Publisher|Timer|Clock|
Time|Duration|Parameter|Point|Quaternion|Pose|Image|Imu|Range|Buffer|Future|Client|Service|ServerGoalHandle|
ClientGoalHandle|ROSClock|RcutilsLogger|Node|QoSProfile|Executor|Transform|\w+Stamped|\w+Executor|OccupancyGrid|
MapMetaData|Path|CameraInfo|PointCloud2|JointState|CvBridge|Bool|U?Int\d+|Thread|Action\w+|\w+_Request|\w+_Response|
\w+_Goal|\w+_Result|\w+_Feedback|TransformListener)')(?=[A-Z])(\w+)' object has no attribute '(\w+)'
    self.{1} is not set when it is used: set it in __init__ before timers and callbacks, spelt the same way
TypeError: can only concatenate str|TypeError: must be str, not
    one side is a text, such as '3': int(text) or float(text) makes a number of it; a number becomes a part of a text in
    an f-string: f'{{value:.2f}}'
IndentationError: unexpected indent
    this line is indented further than the lines it belongs to
IndentationError: expected an indented block
    what belongs to the line above is indented by four more spaces
IndentationError: unindent does not match|TabError
    the lines of one block must begin in the same column, with spaces only
RuntimeError: Context\.init\(\) must only be called once
    call rclpy.init() once, at the start
EOFError: EOF when reading a line
    there is no keyboard here: do not call input()
""")


@explanation
def value_error(error: str, code: str) -> str:
    return listed(error, VALUES)


@explanation
def python_error(error: str, code: str) -> str:
    return listed(error, MEANINGS)


def meaning(error: str, code: str = "") -> str:
    """Return what to change, given the first line of an error as Python prints it; empty if unknown.

    `code` is the line of the program at the end of the traceback.
    """
    return next((said for rule in ROOM.rules() if (said := ask(rule, "", error, code))), "")
