"""What errors of NumPy and of rclpy's parameters mean, and those that execute raised."""

from math import cos

import numpy as np
import pytest
from nav_msgs.msg import OccupancyGrid

from gz_course.grader.feedback.errors.action_errors import execute_raised
from gz_course.grader.feedback.errors.python_errors import meaning

ARRAY = np.arange(6.0)
ROWS = [[1]]


def fill(values):
    OccupancyGrid().data = values


@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda: ARRAY > 1 and ARRAY < 2, "each in brackets"),
        (lambda: ARRAY > 1.0 & ARRAY, "bind stronger"),
        (lambda: ARRAY.reshape(4, 2), "do not make that shape"),
        (lambda: np.zeros((80, 100))[99, 0], "[row, column]"),
        (lambda: ARRAY + np.zeros(2), "do not fit together"),
        (lambda: cos(ARRAY), "np.cos"),
        (lambda: ROWS[ARRAY[0] / 2], "a whole number"),
        (lambda: ROWS[0, 0], "grid[row][column]"),
        (lambda: int(float("inf")), "isfinite()"),
        (lambda: fill([200]), "-1 (unknown), 0 (free) to 100"),
        (lambda: fill(ARRAY), ".astype(np.int8)"),
        (lambda: fill(np.zeros((2, 2), dtype=int)), "one list of whole numbers"),
    ],
)
def test_a_mistake_with_arrays_is_explained(mistake, words):
    with pytest.raises(Exception) as told:
        mistake()
    assert words in meaning(f"{told.type.__name__}: {told.value}".splitlines()[0])


@pytest.mark.parametrize(
    ("error", "words"),
    [
        ("TypeError: unsupported operand type(s) for -: 'float' and 'Parameter'", "get_parameter('NAME').value"),
        ("TypeError: '<' not supported between instances of 'Parameter' and 'int'", "get_parameter('NAME').value"),
        ("ParameterNotDeclaredException: Invalid access to undeclared parameter(s): side", "declare_parameter('side'"),
        ("ParameterAlreadyDeclaredException: Parameter(s) already declared: ['use_sim_time']", "from the start"),
        ("ParameterAlreadyDeclaredException: Parameter(s) already declared: ['side']", "declared once"),
        ("AttributeError: 'ParameterValue' object has no attribute 'value'", "one field for each type"),
        ("TypeError: SetParametersResult.__init__() takes 1 positional argument but 2 were given", "by name"),
        ("TypeError: list indices must be integers or slices, not str", "have numbers, not names"),
        (
            "InvalidParameterTypeException: Trying to set parameter 'distance' to '0.6' of type 'DOUBLE', expecting "
            "type 'INTEGER': distance",
            "distance is of type INTEGER here",
        ),
        ("AttributeError: 'ServerGoalHandle' object has no attribute 'set_succeeded'", "those of ROS 1"),
        ("AttributeError: 'ServerGoalHandle' object has no attribute 'waypoints'", "goal_handle.request"),
        ("AttributeError: 'Patrol_Goal' object has no attribute 'request'", "the goal itself"),
        ("AttributeError: 'Image' object has no attribute 'shape'", "imgmsg_to_cv2"),
        ("RuntimeError: no running event loop", "without asyncio"),
        ("TypeError: Robot.on_pictures() takes 2 positional arguments but 3 were given", "def on_pictures(self, image"),
    ],
)
def test_an_error_of_a_library_is_explained(error, words):
    assert words in meaning(error)


def lines(*texts):
    return [(1.0, "[ERROR] [server.action_server]: Error raised in execute callback: no"), *((1.0, t) for t in texts)]


def test_what_execute_raised_is_named_with_its_line(record):
    told = lines(
        "Traceback (most recent call last):",
        '  File "/x/rclpy/action/server.py", line 336, in _execute_goal',
        '  File "/submission/node.py", line 62, in execute',
        "    goal_handle.set_succeeded(result)",
        "AttributeError: 'ServerGoalHandle' object has no attribute 'set_succeeded'",
    )
    said = execute_raised(record({}, lines=told, submission="node.py"), {})
    assert "(node.py, line 62: goal_handle.set_succeeded(result)); rclpy then ends the goal as ABORTED." in said
    assert "What that means: set_succeeded is no" in said


def test_feedback_of_another_type_is_named(record):
    told = lines(
        "Traceback (most recent call last):",
        '  File "/submission/node.py", line 6, in execute',
        "    goal_handle.publish_feedback(0.5)",
        '  File "/x/rclpy/action/server.py", line 136, in publish_feedback',
        "    raise TypeError()",
        "TypeError",
    )
    assert "such as Patrol.Feedback(...)" in execute_raised(record({}, lines=told, submission="node.py"), {})


def test_a_flag_of_cancellations_that_stays_is_named_with_the_error(record):
    told = lines(
        "Traceback (most recent call last):",
        '  File "/submission/node.py", line 9, in execute',
        "    goal_handle.canceled()",
        "RCLError: goal_handle attempted invalid transition from state EXECUTING with event CANCELED, at goal_handle.c",
    )
    facts = {"suspects": [{"line": 5, "about": "anew", "said": "self.cancelled stays so"}]}
    assert "What that means: line 5: self.cancelled stays so" in execute_raised(
        record({}, facts=facts, lines=told, submission="node.py"), facts
    )
    assert "is for a goal that the client wants to cancel" in execute_raised(
        record({}, lines=told, submission="node.py"), {}
    )


def test_nothing_is_said_where_execute_raised_nothing(record):
    assert execute_raised(record({}, lines=[(1.0, "[INFO] [a]: Goal accepted")], submission="node.py"), {}) == ""


def test_a_colour_picture_that_is_read_as_depths_is_explained():
    said = "CvBridgeError: [rgb8] is a color format but [32FC1] is not so they must have the same OpenCV type, CV_8UC3"
    assert "in the order of the subscribers" in meaning(said)
