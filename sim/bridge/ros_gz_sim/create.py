"""The program `ros2 run ros_gz_sim create -file box.sdf -z 1`, which creates a model in a running world.

It reads options and ROS parameters and calls Gazebo's service `/world/W/create/blocking` once. The text may be SDF or
URDF, a file also xacro, whose expressions are executed as Python. Exit codes: 0 created, 1 not created, 2 invalid
arguments.

Source: ros_gz_sim/src/create.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import math
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.sim import machine_clock
from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read, usage, with_parameters
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros_program.errors import Failure, UsageError, first_line
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import Spinner

if TYPE_CHECKING:
    from rclpy.node import Node

    from gz_course.sim.bridge.ros_gz_sim.running_world import RunningWorld

FLAGS = (
    Flag("world", "World to create it in (default: the one that runs)"),
    Flag("file", "SDF, URDF or xacro file, or model:// or package:// URI"),
    Flag("param", "Name of a ROS parameter of this node that holds the SDF or URDF text", parameter=False),
    Flag("string", "SDF or URDF text"),
    Flag("topic", "Topic that carries the text, such as /robot_description"),
    Flag("name", "Name in the world (default: the one in the file)"),
    Flag("allow_renaming", "Whether a number is put behind a name that is taken", "switch"),
    *(Flag(axis, "Position in the world, m", "number") for axis in "xyz"),
    Flag("R", "Roll, rad", "number"),
    Flag("P", "Pitch, rad", "number"),
    Flag("Y", "Yaw, rad", "number"),
    Flag("timeout", "Longest wait for topic and world together, in s of wall time (default 10)", "number"),
)
HELP = usage(
    "usage: create [-world W] -file F | -string S | -topic T | -param P [options] [--ros-args ...]\n",
    FLAGS,
    "\nEvery option may have two dashes, and be given as a ROS parameter (-param not).",
)
SOURCES = ("file", "param", "string", "topic")


def main(argv: list[str] | None = None) -> int:
    """Create one model and return the exit code."""
    return run("create", "ros_gz_sim", _create, HELP, argv)


def _create(node: Node, arguments: list[str]) -> int:
    from gz_course.sim.bridge.ros_gz_sim.running_world import DEFAULT_TIMEOUT_S, RunningWorld
    from gz_course.sim.gz.transport import Node as GzNode

    values = with_parameters(node, read(arguments, FLAGS), FLAGS)
    given = [name for name in SOURCES if values.get(name)]
    if not given:
        raise UsageError("Must specify either -file, -param, -string or -topic")
    if len(given) > 1:
        raise UsageError(f"-{given[0]} and -{given[1]} are both given; give one of them")
    timeout = values.get("timeout", DEFAULT_TIMEOUT_S)
    start = machine_clock.now()
    text = _text(node, given[0], values[given[0]], timeout)
    logger = node.get_logger()
    with GzNode() as gz_node:
        world = RunningWorld(gz_node, values.get("world", ""), timeout, logger.warning, start=start)
        request = factory(values)
        if given[0] == "file":
            request.sdf_filename = find(values["file"], world)
            if ".xacro" in Path(values["file"]).suffixes:
                logger.warning(
                    f"'{values['file']}' is expanded here, and by no `create` of a full installation: there, give it "
                    "the output of xacro, with -file or -topic"
                )
        else:
            request.sdf = text
        logger.info(f"Requesting creation of an entity in world '{world.name}'")
        if not world.call("create", request):
            raise Failure(why_refused(world, request))
    logger.info(f"Entity creation successful in world '{world.name}'")
    return 0


def factory(values: dict[str, Any]) -> Any:
    """Return the `gz.msgs.EntityFactory` of these options, without the model's text or file.

    The rotation is Rz(Y) Ry(P) Rx(R). The pose is set only when one of its numbers is not zero.
    Source: http://sdformat.org/tutorials?tut=specify_pose
    """
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory

    request = EntityFactory(name=values.get("name", ""), allow_renaming=values.get("allow_renaming", False))
    numbers = {axis: values.get(axis, 0.0) for axis in ("x", "y", "z", "R", "P", "Y")}
    if any(numbers.values()):
        set_pose(request.pose, [numbers[axis] for axis in "xyz"], [numbers[axis] for axis in "RPY"])
    return request


def set_pose(pose: Any, position: list[float], rpy: list[float]) -> None:
    """Fill a `gz.msgs.Pose` from a position [m] and roll, pitch, yaw [rad]."""
    from gz_course.sim.gz.sim.pose import quaternion_from_rpy

    pose.position.x, pose.position.y, pose.position.z = position
    w, x, y, z = map(float, quaternion_from_rpy(*(math.remainder(angle, math.tau) for angle in rpy)))
    pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = w, x, y, z


def find(name: str, world: RunningWorld) -> str:
    """Return the path of a file or URI as resolved by this process, else by the simulator.

    Raises Failure if neither finds it.
    """
    from gz_course.sim.gz.sim.errors import SimError
    from gz_course.sim.gz.sim.sdf.resources import find_model

    try:
        if Path(name).is_file():
            return str(Path(name).resolve())
        return str(find_model(name, None).resolve())
    except (SimError, OSError, ValueError) as error:
        path = world.resolve(name) if "://" in name else ""
        if not path:
            raise Failure(first_line(error)) from None
        return path


def why_refused(world: RunningWorld, request: Any) -> str:
    """Return why the simulator refused to create an entity: a fault of its text or of its name."""
    from gz_course.sim.gz.sim.errors import Diagnostics, SimError
    from gz_course.sim.gz.sim.sdf.reader import read_model
    from gz_course.sim.gz.sim.sdf.resources import read_text

    try:
        file = request.sdf_filename or "<string>"
        text = request.sdf or read_text(Path(request.sdf_filename))
        # strict collects warnings without logging them; the simulator logs them.
        name = request.name or read_model(text, file, Diagnostics(strict=True)).name
    except SimError as error:
        return f"the entity was not created: {first_line(error)}"
    models, lights = world.entities()
    if name in (*models, *lights):
        return (
            f"world '{world.name}' already has something called '{name}'; choose another -name, or add -allow_renaming"
        )
    try:
        read_model(text, file, Diagnostics(strict=True), name)
    except SimError as error:
        return f"the entity was not created: {first_line(error)}"
    return f"world '{world.name}' refused to create '{name}'; the output of gz sim says why"


def _text(node: Node, source: str, value: str, timeout: float) -> str:
    """Return the text of a source; empty for a file."""
    if source == "string":
        return value
    if source == "topic":
        return _from_topic(node, value, timeout)
    if source == "param":
        return _from_parameter(node, value)
    return ""


def _from_parameter(node: Node, name: str) -> str:
    value = node.get_parameter(name).value if node.has_parameter(name) else None
    if not isinstance(value, str) or not value:
        known = sorted(node.get_parameters_by_prefix(""))
        raise UsageError(
            f"-param names the parameter '{name}', which this node does not have as a text; give it with "
            f"--ros-args -p {name}:=...{did_you_mean(name, known, listing='its parameters are')}"
        )
    return value


def _from_topic(node: Node, topic: str, timeout: float) -> str:
    """Return the first text on a topic, also one that was published before (transient local)."""
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    heard = threading.Event()
    texts: list[str] = []

    def take(message: String) -> None:
        texts.append(message.data)
        heard.set()

    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    try:
        name = node.create_subscription(String, topic, take, profile).topic_name
    except Exception as error:
        raise UsageError(f"-topic cannot be '{topic}': {first_line(error)}") from None
    node.get_logger().info(f"Waiting messages on topic [{name}].")
    with Spinner(node):
        if machine_clock.await_event(heard, timeout) and texts[0].strip():
            return texts[0]
        publishers = node.get_publishers_info_by_topic(name)
    if heard.is_set():
        raise Failure(f"the message on the topic '{name}' is empty; robot_description should hold a URDF")
    wrong = next((each.topic_type for each in publishers if each.topic_type != "std_msgs/msg/String"), "")
    if wrong:
        reason = f"it carries {wrong}, and std_msgs/msg/String is needed"
    elif publishers:
        reason = "its publisher sent nothing; to receive an earlier message its durability must be transient local"
    else:
        reason = "nobody publishes it; is robot_state_publisher running, in the same ROS_DOMAIN_ID?"
    raise Failure(f"no message came on the topic '{name}' within {timeout:g} s: {reason}")


if __name__ == "__main__":
    sys.exit(main())
