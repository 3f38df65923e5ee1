"""Misuse of rclpy: methods of other names, arguments that do not exist, names that a node has already.

Source: the public classes and functions of rclpy 7.1 (ROS 2 Jazzy); the names of rospy and roscpp, for those who know
ROS 1.
"""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import explanation

BEFORE = ("operands",)

# What beginners call on the node -> what there is.
OF_A_NODE = {
    "now": "self.get_clock().now()", "get_time": "self.get_clock().now()", "time": "self.get_clock().now()",
    "clock": "self.get_clock()", "get_now": "self.get_clock().now()", "get_rostime": "self.get_clock().now()",
    "logger": "self.get_logger()", "log": "self.get_logger().info('text')",
    "info": "self.get_logger().info('text')", "loginfo": "self.get_logger().info('text')",
    "warn": "self.get_logger().warning('text')", "get_log": "self.get_logger()",
    "sleep": "a timer, self.create_timer(PERIOD, callback): a node does not sleep",
    "rate": "a timer, self.create_timer(PERIOD, callback)",
    "publish": "publish() of the publisher that self.create_publisher(TYPE, '/topic', 10) returned",
    "spin": "rclpy.spin(node), outside of the class",
    "create_subscriber": "self.create_subscription(TYPE, '/topic', callback, 10)",
    "subscribe": "self.create_subscription(TYPE, '/topic', callback, 10)",
    "create_subscripton": "self.create_subscription(TYPE, '/topic', callback, 10)",
    "advertise": "self.create_publisher(TYPE, '/topic', 10)",
    "create_pub": "self.create_publisher(TYPE, '/topic', 10)",
    "add_publisher": "self.create_publisher(TYPE, '/topic', 10)",
    "create_wall_timer": "self.create_timer(PERIOD in seconds, callback)",
    "add_timer": "self.create_timer(PERIOD in seconds, callback)",
    "set_timer": "self.create_timer(PERIOD in seconds, callback)",
    "get_param": "self.get_parameter('NAME').value", "param": "self.get_parameter('NAME').value",
    "create_parameter": "self.declare_parameter('NAME', DEFAULT)",
    "shutdown": "rclpy.shutdown()", "ok": "rclpy.ok()", "is_shutdown": "rclpy.ok()",
}  # fmt: skip
OF_RCLPY = {
    "init_node": "rclpy.init() and then a node, Node('NAME')",
    "Publisher": "self.create_publisher(TYPE, '/topic', 10) of a node",
    "Subscriber": "self.create_subscription(TYPE, '/topic', callback, 10) of a node",
    "Service": "self.create_service(TYPE, 'name', callback) of a node",
    "ServiceProxy": "self.create_client(TYPE, 'name') of a node",
    "Rate": "a timer, self.create_timer(PERIOD in seconds, callback)",
    "Timer": "self.create_timer(PERIOD in seconds, callback) of a node",
    "sleep": "a timer, self.create_timer(PERIOD in seconds, callback)",
    "loginfo": "self.get_logger().info('text') of a node", "logwarn": "self.get_logger().warning('text') of a node",
    "logerr": "self.get_logger().error('text') of a node", "logging_info": "self.get_logger().info('text')",
    "now": "self.get_clock().now() of a node", "get_time": "self.get_clock().now() of a node",
    "is_shutdown": "rclpy.ok()", "spinOnce": "rclpy.spin_once(node)", "run": "rclpy.spin(node)",
    "spin_some": "rclpy.spin_once(node)", "get_param": "self.get_parameter('NAME').value of a node",
}  # fmt: skip
OTHER_MODULES = {
    ("time", "now"): "time.time() is the time of the wall clock; simulated time is self.get_clock().now()",
    ("math", "PI"): "it is math.pi, in lower case",
    ("math", "deg2rad"): "it is math.radians(degrees)",
    ("math", "rad2deg"): "it is math.degrees(radians)",
    ("math", "abs"): "abs() is built in; math has fabs()",
    ("math", "min"): "min() is built in",
    ("math", "max"): "max() is built in",
    ("math", "sign"): "it is math.copysign(1.0, value), or np.sign(value)",
    ("numpy", "float"): "it is the float of Python, or np.float64",
    ("numpy", "int"): "it is the int of Python, or np.int64",
    ("numpy", "bool"): "it is the bool of Python, or np.bool_",
}
# Callable -> its arguments, for a keyword that does not exist.
ARGUMENTS = {
    "Duration.__init__": "Duration(seconds=5.0), or nanoseconds=",
    "Time.__init__": "Time(seconds=5.0), or nanoseconds=; Time.from_msg(stamp) makes one of a stamp",
    "Node.create_timer": "create_timer(timer_period_sec, callback)",
    "Node.create_publisher": "create_publisher(msg_type, topic, qos_profile)",
    "Node.create_subscription": "create_subscription(msg_type, topic, callback, qos_profile)",
    "Node.create_service": "create_service(srv_type, srv_name, callback)",
    "Node.create_client": "create_client(srv_type, srv_name)",
    "Node.declare_parameter": "declare_parameter(name, value)",
    "Node.get_parameter": "get_parameter(name)",
    "Node.__init__": "Node(node_name, namespace=...)",
    "QoSProfile.__init__": "QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)",
    "Publisher.publish": "publish(message)",
    "ActionServer.__init__": "ActionServer(node, TYPE, 'name', execute_callback)",
    "TransformListener.__init__": "TransformListener(buffer, node)",
    "TransformBroadcaster.__init__": "TransformBroadcaster(node)",
    "StaticTransformBroadcaster.__init__": "StaticTransformBroadcaster(node)",
    "Node.get_logger": "get_logger() without arguments: get_logger().info('text')",
    "Node.get_clock": "get_clock() without arguments: get_clock().now()",
    "ROSClock.now": "now() without arguments",
    "Clock.now": "now() without arguments",
    "Timer.cancel": "cancel() without arguments",
    "Node.destroy_timer": "destroy_timer(timer)",
    "spin": "rclpy.spin(node)",
    "spin_once": "rclpy.spin_once(node, timeout_sec=0.1)",
    "shutdown": "rclpy.shutdown()",
    "RcutilsLogger.info": "info(text) with one text: f'speed {speed}' puts a value into it",
    "RcutilsLogger.warning": "warning(text) with one text: f'speed {speed}' puts a value into it",
    "RcutilsLogger.warn": "warn(text) with one text: f'speed {speed}' puts a value into it",
    "RcutilsLogger.error": "error(text) with one text: f'speed {speed}' puts a value into it",
    "RcutilsLogger.debug": "debug(text) with one text: f'speed {speed}' puts a value into it",
    "RcutilsLogger.log": "info(text), warning(text) or error(text) instead of log",
}
# Classes of libraries, whose methods a student does not define.
LIBRARY = frozenset({
    "Node", "Publisher", "Subscription", "Timer", "Clock", "ROSClock", "Duration", "Time", "RcutilsLogger",
    "QoSProfile", "Future", "Client", "Service", "Buffer", "ActionServer", "ActionClient", "ServerGoalHandle",
    "TransformListener",
    "TransformBroadcaster", "StaticTransformBroadcaster", "MultiThreadedExecutor", "SingleThreadedExecutor", "CvBridge",
    "Parameter", "Thread",
})  # fmt: skip
FUNCTIONS = frozenset({"spin", "spin_once", "shutdown"})


@explanation
def arguments(error: str, code: str) -> str:
    """Explain a call of rclpy with arguments that it does not take."""
    if re.search(r"Node\.__init__\(\) got an unexpected keyword argument 'use_sim_time'", error):
        return (
            "use_sim_time is a parameter and comes from outside: parameters=[{'use_sim_time': True}] in a launch file"
        )
    match = re.search(r"TypeError: ([\w.]+)\(\) (got an unexpected|takes|missing|got multiple)", error)
    if match is None:
        return ""
    function = match[1]
    owner, _, method = function.rpartition(".")
    if function == "Node.__init__" and "missing" in error:
        texts = re.search(r"Node\.__init__\(\s*['\"]", code)
        return "called on the class, it needs the node itself first: super().__init__('NODE_NAME')" if texts else ""
    if function == "Node.__init__" and "takes 2" in error:
        return "super().__init__('NODE_NAME') takes the name only: self is passed by super() already"
    if owner not in LIBRARY and function not in FUNCTIONS:
        return ""
    if "missing" in error and method in ("create_subscription", "create_publisher", "create_timer"):
        return ""  # the tables of `python_errors.py` say which one
    if (method in ("create_subscription", "create_publisher") and "takes" in error) or method == "spin_once":
        return ""
    return f"the call is {ARGUMENTS[function]}" if function in ARGUMENTS else ""


@explanation
def newer_init(error: str, code: str) -> str:
    """Explain `with rclpy.init():`, for which rclpy returns an object from ROS 2 Kilted on."""
    if "rclpy.init(" in code and re.search(r"context manager protocol|__enter__", error):
        return (
            "rclpy.init() returns None on Jazzy; only in newer distributions does it return what `with` needs: call it "
            "on a line of its own"
        )
    return ""


@explanation
def own_arguments(error: str, code: str) -> str:
    """Explain a call in the student's own file of a method of theirs with the wrong number of arguments."""
    match = re.search(
        r"TypeError: (?:(\w+)\.)?(?!__)(\w+)\(\) (?:takes (?:from \d+ to )?(\d+) positional arguments? but (\d+) w|"
        r"missing (\d+) required positional arguments?: (.*))",
        error,
    )
    if match is None or match[1] in LIBRARY or match[2] in FUNCTIONS or not re.search(rf"\b{match[2]}\(", code):
        return ""
    owner, name, takes, given, _, missing = match.groups()
    own = 1 if owner else 0  # the object itself is counted
    if missing == "'self'":
        return ""
    if missing:
        return (
            f"def {name} has the parameter{'' if ' and ' not in missing else 's'} {missing}, and this call passes "
            "no value for it"
        )
    if owner and takes == "0":
        return ""
    return (
        f"def {name} takes {int(takes) - own} argument{'' if int(takes) - own == 1 else 's'} besides self, and this "
        f"call passes {int(given) - own}"
        if owner
        else f"def {name} takes {takes} argument{'' if takes == '1' else 's'}, and this call passes {given}"
    )


@explanation
def attributes(error: str, code: str) -> str:
    """Explain a method or module attribute that has another name, or a name that a node has already."""
    if match := re.search(r"AttributeError: module '(\w+)' has no attribute '(\w+)'", error):
        module, name = match.groups()
        if module == "rclpy" and name in OF_RCLPY:
            return f"rclpy has no {name}; there is {OF_RCLPY[name]}"
        return OTHER_MODULES.get((module, name), "")
    if match := re.search(
        r"AttributeError: property '(\w+)' of '\w+' object has no setter|AttributeError: (\w+) cannot be", error
    ):
        name = match[1] or match[2]
        return (
            f"every Node has a {name} of its own, which cannot be set: give yours another name, such as self.my_{name}"
        )
    if match := re.search(r"AttributeError: '([A-Z]\w*)' object has no attribute '(\w+)'", error):
        owner, name = match.groups()
        if owner not in LIBRARY and name in OF_A_NODE and f"self.{name}" in code:
            return f"a node has no {name}; there is {OF_A_NODE[name]}"
    return ""
