"""What errors of NumPy, cv_bridge, message_filters, and of rclpy's parameters and actions mean; for `python_errors.py`.

Only errors with a certain cause are listed. Source: the error texts of NumPy 1.26 and 2, cv_bridge and message_filters
of ROS 2 Jazzy, and rclpy 7.1.
"""

from __future__ import annotations

from gz_course.grader.feedback.errors import explanation, listed, table

BEFORE = ("fields",)

# Pattern of an error -> what to change. {0}, {1} are the groups of the pattern.
MEANINGS = table(r"""
AttributeError: 'Subscription' object has no attribute 'registerCallback'
    a synchronizer takes subscriptions of message_filters, message_filters.Subscriber(self, TYPE, '/topic'), and not
    those of create_subscription
# arrays
ValueError: The truth value of an array with more than one element is ambiguous
    `and`, `or`, `not` and `if` ask for one truth value, and an array has many: conditions on arrays are combined with
    &, | and ~, each in brackets, as in (a > 1) & (b < 2)
TypeError: ufunc 'bitwise_(?:and|or)' not supported for the input types
    & and | bind stronger than comparisons: each condition needs brackets, as in (a > 1) & (b < 2)
TypeError: unsupported operand type\(s\) for \^=?: '(?:float|int|numpy\.float\d+)'
    ^ is an operator on bits, for whole numbers: a power is written with **, as in x ** 2
TypeError: unsupported operand type\(s\) for [&|]: '(?:float|numpy\.float\d+)'
    & and | bind stronger than comparisons: each condition needs brackets, as in (a > 1) & (b < 2)
ValueError: cannot reshape array of size (\d+) into shape \((\d+), ?(\d+)(?:, ?\d+)?\)
    {0} numbers do not make that shape: an image has height rows of width pixels, a colour image 3 numbers of 8 bits for
    each pixel, a depth image of 32FC1 one float32 (np.frombuffer(data, dtype=np.float32))
ValueError: operands could not be broadcast together with shapes (\([\d, ]*\)) (\([\d, ]*\))
    two arrays of the shapes {0} and {1} do not fit together number by number
TypeError: only (?:length-1|size-1|0-dimensional) arrays can be converted
    an array is given where one number is needed: functions of math take one number, those of NumPy (np.cos,
    np.isfinite) take arrays
(?:ValueError: cannot convert float NaN|OverflowError: cannot convert float infinity) to integer
    a range of a ray that hit nothing is inf, or NaN, and is no place: leave out what is not isfinite() before int(...)
OverflowError: signed char is (greater|less) than (?:maximum|minimum)
    data of an OccupancyGrid are whole numbers of 8 bits, -1 (unknown), 0 (free) to 100 (occupied): one of yours is {0}
    than 8 bits can hold
TypeError: '(?:float|numpy\.float\d+)' object cannot be interpreted as an integer
    a whole number is needed there: int(...), or .astype(np.int8) for a whole array
TypeError: (?:only integer scalar arrays can be converted to a scalar index|
'list' object cannot be interpreted as an integer)
    data of a map is one list of whole numbers, row after row: .flatten().tolist() makes it of an array of rows
# pictures
(?:Attribute|Type)Error: '(Image|CompressedImage)' object (?:has no attribute|is not subscr)
    a message of the type {0} is no array: CvBridge().imgmsg_to_cv2(message, 'rgb8') makes one
CvBridgeError: \[(\w+8)\] is a color format but \[(32FC1|16UC1)\] is not
    this message is a picture of colours ({0}), and it is read as depths ({1}): look at which topic it comes from; the
    callback of a synchronizer gets its messages in the order of the subscribers
CvBridgeError: (?:.*is not a color format|.*do not have the same number of channel)
    a picture of colours and one of numbers (32FC1: depth in metres) cannot be converted into each other: ask for rgb8
    for the camera's, 32FC1 for the depth camera's
TypeError: (?:\w+\.)*(\w+)\(\) takes 2 positional arguments but 3 were given
    {0} is called with two things: the callback of a synchronizer gets one message of each topic, as in def {0}(self,
    image, depth)
TypeError: ApproximateTimeSynchronizer\.__init__\(\) missing 1 required positional argument
    the order is ApproximateTimeSynchronizer([subscriber, subscriber], queue_size, slop in seconds)
TypeError: (?:Approximate)?TimeSynchronizer\.__init__\(\) takes
    the subscribers are one list: TimeSynchronizer([subscriber, subscriber], 10)
AttributeError: 'Subscriber' object has no attribute '(\w+)'
    a message_filters.Subscriber hands its messages to registerCallback(...), or to a synchronizer
# parameters
(?:unsupported operand type\(s\) for .*|not supported between .*|real number, not )'?ParameterValue'?
    get_parameter_value() has one field for each type, such as .double_value; .value of the parameter is simpler
AttributeError: 'ParameterValue' object has no attribute '\w+'
    get_parameter_value() has one field for each type, such as .double_value; .value of the parameter is simpler
TypeError: SetParametersResult\.__init__\(\) takes 1 positional
    the fields of a message are given by name: SetParametersResult(successful=True)
ParameterNotDeclaredException: Invalid access to undeclared parameter\(s\): (\w+)
    declare_parameter('{0}', DEFAULT) must have been called before, in __init__, with the same name
InvalidParameterTypeException: Trying to set parameter '(\w+)' to '([^']*)' of type 'STRING', expecting type 'BOOL'
    {0} is given as a text, '{1}' in quotes, and is of type BOOL: that is True or False in Python, and {0}:=true on a
    command line, without quotes
InvalidParameterTypeException: Trying to set parameter '(\w+)' to '(-?\d*\.?\d*)' of type 'STRING', expecting type '(D
OUBLE|INTEGER)'
    {0} is given as a text, '{1}', and its default in declare_parameter() is of type {2}: a number has no quotes, and in
    a launch file ParameterValue(..., value_type=float), or int, makes one of a text
InvalidParameterTypeException: Trying to set parameter '(\w+)' to '([^']*)' of type 'STRING', expecting type '(DOUBL
E|INTEGER)'
    the value '{1}' that comes from outside for {0} is no number, and its default in declare_parameter() is of type {2}
InvalidParameterTypeException: Trying to set parameter '(\w+)' to '(-?\d+)' of type 'INTEGER', expecting type 'DOUBLE'
    the value {1} that comes from outside for {0} is of type INTEGER, and the default in declare_parameter() is of type
    DOUBLE: a DOUBLE has a point, so write {1}.0
InvalidParameterTypeException: Trying to set parameter '(\w+)' to '([^']*)' of type '(\w+)', expecting type '(\w+)'
    the default in declare_parameter() gives a parameter its type: {0} is of type {3} here, but the value {1} that is
    given from outside is of type {2}; a DOUBLE has a point, such as 1.0
ParameterAlreadyDeclaredException.*\buse_sim_time\b
    every node has the parameter use_sim_time from the start: leave this line out; its value comes from outside, such as
    parameters=[{{'use_sim_time': True}}] in the launch file
ParameterAlreadyDeclaredException
    a parameter is declared once, in __init__; afterwards get_parameter('NAME').value reads it
# actions
AttributeError: 'ActionServer' object has no attribute '(publish_feedback|succeed|abort|canceled|is_cancel_requested|
request)'
    {0} belongs to the goal and not to the server: it is that of the goal handle that execute gets, goal_handle.{0}
AttributeError: 'ServerGoalHandle' object has no attribute '(set_\w+|cancel(?:led|l?ing)?)'
    {0} is no method of rclpy's goal handle (set_... are those of ROS 1): a goal ends with goal_handle.succeed(),
    canceled() or abort(), without arguments, and the result is returned
AttributeError: 'ServerGoalHandle' object has no attribute 'is_(?:preempt|cancel)\w*'
    whether the client wants to cancel is goal_handle.is_cancel_requested, without brackets
AttributeError: 'ServerGoalHandle' object has no attribute '(\w+)'
    {0} is no attribute of the goal handle: what the client asks for is in goal_handle.request, and the result is
    returned
AttributeError: '\w+_Goal' object has no attribute 'request'
    goal_callback gets the goal itself, and execute a goal handle: goal.waypoints there, goal_handle.request.waypoints
    here
AttributeError: '(\w+)_(Goal|Result|Feedback)' object has no attribute '(\w+)'
    the {1} of {0}.action has no field {2}: ros2 interface show prints its fields
AttributeError: type object '(\w+)' has no attribute '(?!_)(\w+)'
    {0} has no {1}: an action has the parts {0}.Goal, {0}.Result and {0}.Feedback
invalid transition from state (?:SUCCEEDED|CANCELED|ABORTED) with event (\w+)
    the goal had ended already: after succeed(), canceled() or abort() execute must return, and none of them is called a
    second time
invalid transition from state EXECUTING with event CANCELED
    canceled() is for a goal that the client wants to cancel, where goal_handle.is_cancel_requested is true
TypeError: ServerGoalHandle\.(\w+)\(\) takes 1 positional argument but 2 were given
    {0}() takes no argument: execute returns the result
RuntimeError: no running event loop
    rclpy's executor runs coroutines without asyncio: asyncio.sleep() and the like cannot be awaited in a callback;
    time.sleep() in a MultiThreadedExecutor, or a Future that a timer completes, waits
TypeError: object (\w+) can't be used in 'await' expression
    only a coroutine or a Future can be awaited, and this is a {0}: leave out await
""")


@explanation
def library_error(error: str, code: str) -> str:
    return listed(error, MEANINGS)
