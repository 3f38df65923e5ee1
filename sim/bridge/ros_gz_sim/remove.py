"""The program `ros2 run ros_gz_sim remove --ros-args -p entity_name:=box`, which removes a model from a running world.

Exit codes as for `create`.

Source: ros_gz_sim/src/remove.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from gz_course.sim.bridge.ros_gz_sim.delete_entity import MODEL, delete
from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read, usage, with_parameters
from gz_course.sim.ros.ros_program.errors import UsageError
from gz_course.sim.ros.ros_program.program import run

if TYPE_CHECKING:
    from rclpy.node import Node

FLAGS = (
    Flag("world", "World to remove it from (default: the one that runs)"),
    Flag("entity_name", "Name of the model"),
    Flag("timeout", "Longest wait for the world, in s of wall time (default 10)", "number"),
)
HELP = usage(
    "usage: remove --ros-args -p entity_name:=NAME [-p world:=W]\n"
    "       remove -entity_name NAME [-world W]\n",
    FLAGS,
)  # fmt: skip


def main(argv: list[str] | None = None) -> int:
    """Remove one model and return the exit code."""
    return run("remove", "ros_gz_sim", _remove, HELP, argv)


def _remove(node: Node, arguments: list[str]) -> int:
    values = with_parameters(node, read(arguments, FLAGS), FLAGS)
    if not values.get("entity_name"):
        raise UsageError("there is nothing to remove; give -entity_name, or -p entity_name:=NAME")
    return delete(node, values, {"name": values["entity_name"], "type": MODEL})


if __name__ == "__main__":
    sys.exit(main())
