"""Names that are not there: where the course's classes and functions are imported from, and words of other languages.

Source: the modules of rclpy, tf2_ros and the message packages of ROS 2 Jazzy; `keyword` and `builtins` of Python 3.
"""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import explanation

BEFORE = ("node_interface",)

# Module -> what beginners import from it.
MODULES = {
    "rclpy.node": "Node",
    "rclpy.duration": "Duration",
    "rclpy.time": "Time",
    "rclpy.clock": "Clock ClockType",
    "rclpy.parameter": "Parameter",
    "rclpy.qos": "QoSProfile QoSReliabilityPolicy QoSDurabilityPolicy QoSHistoryPolicy ReliabilityPolicy "
    "DurabilityPolicy HistoryPolicy qos_profile_sensor_data qos_profile_system_default",
    "rclpy.executors": "MultiThreadedExecutor SingleThreadedExecutor ExternalShutdownException",
    "rclpy.callback_groups": "ReentrantCallbackGroup MutuallyExclusiveCallbackGroup",
    "rclpy.action": "ActionServer ActionClient CancelResponse GoalResponse",
    "rcl_interfaces.msg": "SetParametersResult ParameterDescriptor ParameterType",
    "tf2_ros": "Buffer TransformListener TransformBroadcaster StaticTransformBroadcaster TransformException "
    "LookupException ExtrapolationException ConnectivityException",
    "std_msgs.msg": "String Bool Float32 Float64 Int8 Int16 Int32 Int64 UInt8 UInt16 UInt32 UInt64 Header Empty "
    "Float32MultiArray Float64MultiArray Int32MultiArray ColorRGBA",
    "geometry_msgs.msg": "Twist TwistStamped Vector3 Vector3Stamped Point PointStamped Pose PoseStamped PoseArray "
    "Quaternion QuaternionStamped Transform TransformStamped PoseWithCovarianceStamped",
    "sensor_msgs.msg": "LaserScan Image CameraInfo Imu PointCloud2 JointState Range NavSatFix",
    "nav_msgs.msg": "Odometry OccupancyGrid Path MapMetaData",
    "rosgraph_msgs.msg": "Clock",
    "std_srvs.srv": "Empty SetBool Trigger",
    "visualization_msgs.msg": "Marker MarkerArray",
    "cv_bridge": "CvBridge",
    "message_filters": "Subscriber TimeSynchronizer ApproximateTimeSynchronizer",
    "builtin_interfaces.msg": "Time Duration",
    "math": "sin cos tan asin acos atan atan2 sqrt hypot pi radians degrees isfinite isinf isnan inf nan fabs floor "
    "ceil",
    "functools": "partial",
    "threading": "Thread",
    "collections": "deque defaultdict Counter",
}
WHOLE = frozenset({
    "math", "time", "os", "sys", "random", "rclpy", "json", "threading", "functools", "collections", "numpy", "np",
    "tf2_ros", "yaml",
})  # fmt: skip

# Words of other languages, or of other capitals -> Python's.
WORDS = {
    "true": "True", "false": "False", "null": "None", "none": "None", "nil": "None", "NULL": "None", "nullptr": "None",
    "this": "self", "Self": "self", "TRUE": "True", "FALSE": "False", "println": "print", "printf": "print",
    "echo": "print", "Math": "math", "length": "len", "abs_": "abs", "string": "str", "String_": "str",
    "PI": "math.pi", "M_PI": "math.pi", "INFINITY": "math.inf", "NaN": "math.nan",
}  # fmt: skip


def homes(name: str) -> list[str]:
    """Return the modules that have `name`; those a node is likelier to want come first."""
    return [module for module, names in MODULES.items() if name in names.split()]


def statement(name: str) -> str:
    """Return the import statement of `name`, or several joined by `or`; empty if it is unknown."""
    if name in WHOLE:
        return "import numpy as np" if name == "np" else f"import {name}"
    return " or ".join(f"from {module} import {name}" for module in homes(name))


@explanation
def import_fault(error: str, code: str) -> str:
    """Explain an import of what lies elsewhere, is called otherwise, or belongs to ROS 1."""
    if match := re.search(
        r"No module named '(?:rospy|roslib|tf|actionlib|roscpp|dynamic_reconfigure)(?:\.\w+)?'", error
    ):
        return "that belongs to ROS 1; in ROS 2 a node imports rclpy, and tf2_ros for transforms"
    if match := re.search(r"No module named '([\w.]*?)\.?(\w+)'(?:; '[\w.]+' is not a package)?$", error):
        parent, name = match.groups()
        if (place := statement(name)) and (parent or name not in WHOLE):
            return f"{name} is no module, but a name in one: {place}"
        if "is not a package" in error and code.split()[:1] == ["import"]:
            return f"what is in a module is imported by from: from {parent} import {name}"
    if match := re.search(r"cannot import name '(\w+)' from '([\w.]+)'", error):
        name, given = match.groups()
        if given.endswith("_msgs") or (given == "rclpy" and name == "Node"):
            return ""  # the tables of `python_errors.py` name the module
        places = [module for module in homes(name) if module != given]
        if places and given not in homes(name):
            return f"{name} is not in {given}: from {places[0]} import {name}"
    if (match := re.search(r"module '([\w.]+)' has no attribute '(\w+)'", error)) and match[2] in dict.fromkeys(
        name for names in MODULES.values() for name in names.split()
    ):
        module, name = match.groups()
        if module not in homes(name) and not (module == "rclpy" and name == "Node"):
            return f"{name} is not in {module}: {statement(name)}"
    return ""


@explanation
def unknown_name(error: str, code: str) -> str:
    """Explain a NameError: a missing import, a word of another language, a class that is called otherwise."""
    match = re.search(r"NameError: name '(\w+)' is not defined", error)
    if match is None or match[1] == "self":
        return ""
    name = match[1]
    if name in WORDS:
        return f"Python writes it {WORDS[name]}"
    if place := statement(name):
        return f"the import of {name} is missing: {place}"
    if re.search(rf"\bself\.\w+\([^)]*\b{name}\b", code) or re.search(rf"create_\w+\(.*\b{name}\b", code):
        return f"no variable or function {name} exists here; a method of the class is passed as self.{name}"
    if name[:1].isupper() and not name.isupper():
        return f"no class {name} is defined or imported in this file: the name after class, or an import, is another"
    return (
        f"no variable or function of that name exists here; what belongs to the node is reached with self.{name}, a "
        "text stands in quotes, and a variable of another function is not seen here"
    )
