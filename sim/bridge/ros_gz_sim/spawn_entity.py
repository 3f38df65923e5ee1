"""The program `ros2 run ros_gz_sim spawn_entity --sdf_filename box.sdf --pos 1 2 0.5`, which creates a model.

It calls Gazebo's service `/world/W/create/blocking`, without a bridge. `set_entity_pose` has the same options for a
pose. Exit codes as for `create`.

Source: ros_gz_sim/src/spawn_entity.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

from gz_course.sim.bridge.ros_gz_sim.create import find, set_pose, why_refused
from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read, usage
from gz_course.sim.ros.ros_program.errors import Failure, UsageError
from gz_course.sim.ros.ros_program.program import run

if TYPE_CHECKING:
    from rclpy.node import Node

POSE = (
    Flag("pos", "Position x y z in the world, m", "number", 3),
    Flag("quat", "Orientation as quaternion x y z w", "number", 4),
    Flag("euler", "Orientation as roll pitch yaw, rad", "number", 3),
)
FLAGS = (
    Flag("world", "World to spawn it in (default: the one that runs)"),
    Flag("name", "Name in the world (default: the one in the file)"),
    Flag("sdf_filename", "SDF, URDF or xacro file, or model:// or package:// URI"),
    Flag("sdf_string", "SDF or URDF text"),
    Flag("allow_renaming", "Whether a number is put behind a name that is taken", "switch"),
    *POSE,
    Flag("timeout", "Longest wait for the world, in s of wall time (default 10)", "number"),
)
HELP = usage("usage: spawn_entity --sdf_filename F | --sdf_string S [--name NAME] [options]\n", FLAGS)


def main(argv: list[str] | None = None) -> int:
    """Spawn one entity and return the exit code."""
    return run("spawn_entity", "entity_spawner", _spawn, HELP, argv)


def _spawn(node: Node, arguments: list[str]) -> int:
    from gz_course.sim.bridge.ros_gz_sim.running_world import DEFAULT_TIMEOUT_S, RunningWorld
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
    from gz_course.sim.gz.transport import Node as GzNode

    values = read(arguments, FLAGS)
    if bool(values.get("sdf_filename")) == bool(values.get("sdf_string")):
        raise UsageError("say what to spawn: give --sdf_filename or --sdf_string, one of them")
    request = EntityFactory(
        name=values.get("name", ""),
        sdf=values.get("sdf_string", ""),
        allow_renaming=values.get("allow_renaming", False),
    )
    fill_pose(request, "pose", values)
    logger = node.get_logger()
    with GzNode() as gz_node:
        timeout = values.get("timeout", DEFAULT_TIMEOUT_S)
        world = RunningWorld(gz_node, values.get("world", ""), timeout, logger.warning)
        if values.get("sdf_filename"):
            request.sdf_filename = find(values["sdf_filename"], world)
        if not world.call("create", request):
            raise Failure(why_refused(world, request))
    logger.info(f"Entity creation successful in world '{world.name}'")
    return 0


def fill_pose(message: Any, field: str, values: dict[str, Any]) -> bool:
    """Set the pose in `field` of a message (empty: the message itself) from --pos and --quat or --euler.

    Return False if none of them is given. Raises UsageError for both orientations, or a quaternion of length zero.
    """
    if "quat" in values and "euler" in values:
        raise UsageError("--quat and --euler are both given; give one of them")
    if not {"pos", "quat", "euler"} & set(values):
        return False
    pose = getattr(message, field) if field else message
    set_pose(pose, values.get("pos", [0.0] * 3), values.get("euler", [0.0] * 3))
    if "quat" in values:
        length = math.hypot(*values["quat"])
        if not 1e-9 < length < math.inf:
            raise UsageError("--quat must not be all zeros; its four numbers are x y z w, 0 0 0 1 for no rotation")
        x, y, z, w = (part / length for part in values["quat"])
        pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = x, y, z, w
    return True


if __name__ == "__main__":
    sys.exit(main())
