"""The program `ros2 run ros_gz_sim set_entity_pose --name box --pos 1 2 0.5`, which moves a model or a light.

It calls Gazebo's service `/world/W/set_pose/blocking`, without a bridge. Exit codes as for `create`.

Source: ros_gz_sim/src/set_entity_pose.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from gz_course.sim.bridge.ros_gz_sim.delete_entity import WHICH, missing, which
from gz_course.sim.bridge.ros_gz_sim.flags import read, usage
from gz_course.sim.bridge.ros_gz_sim.spawn_entity import POSE, fill_pose
from gz_course.sim.ros.ros_program.errors import Failure, UsageError
from gz_course.sim.ros.ros_program.program import run

if TYPE_CHECKING:
    from rclpy.node import Node

FLAGS = (*WHICH, *POSE)
HELP = usage("usage: set_entity_pose --name NAME | --id N --pos X Y Z [--euler R P Y | --quat X Y Z W]\n", FLAGS)


def main(argv: list[str] | None = None) -> int:
    """Move one entity and return the exit code."""
    return run("set_entity_pose", "entity_pose_setter", _set_pose, HELP, argv)


def _set_pose(node: Node, arguments: list[str]) -> int:
    from gz_course.sim.bridge.ros_gz_sim.running_world import DEFAULT_TIMEOUT_S, RunningWorld
    from gz_course.sim.gz.msgs.pose_pb2 import Pose
    from gz_course.sim.gz.transport import Node as GzNode

    values = read(arguments, FLAGS)
    entity = which(values)
    request = Pose(name=entity.get("name", ""), id=entity.get("id", 0))
    if not fill_pose(request, "", values):
        raise UsageError("there is no pose; give --pos X Y Z, and --euler or --quat for the orientation")
    logger = node.get_logger()
    with GzNode() as gz_node:
        timeout = values.get("timeout", DEFAULT_TIMEOUT_S)
        world = RunningWorld(gz_node, values.get("world", ""), timeout, logger.warning)
        if not world.call("set_pose", request):
            raise Failure(missing(world, entity) or f"world '{world.name}' refused; the output of gz sim says why")
    logger.info(f"Entity pose set in world '{world.name}': {request.name or request.id}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
