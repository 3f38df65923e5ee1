"""The program `ros2 run robot_state_publisher robot_state_publisher robot.urdf`.

The text may also be in the parameter robot_description. A robot_state_publisher of a ROS installation is started
instead. Exit codes: 0 after SIGINT or SIGTERM, 2 for unusable arguments, 1 if a callback failed.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.ros.ros_program.errors import UsageError, first_line
from gz_course.sim.ros.ros_program.parameters import read_parameters
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "robot_state_publisher"
HELP = """\
usage: robot_state_publisher [URDF FILE] [--ros-args ...]

Publishes /robot_description, and /tf and /tf_static from /joint_states.

ROS parameters (after --ros-args, each as -p name:=value):
  robot_description   the URDF as a text; not together with a file
  publish_frequency   how often a joint's transform is published at most, in Hz (default 20)
  frame_prefix        put before the name of every frame
  ignore_timestamp    true: publish for every joint state, whatever its stamp (default false)
"""


def main(argv: list[str] | None = None) -> int:
    """Publish until SIGINT or SIGTERM and return the exit code."""
    arguments = sys.argv[1:] if argv is None else argv
    program = installed(os.environ.get("AMENT_PREFIX_PATH", ""))
    if program is not None:
        os.execv(program, [str(program), *arguments])
    return run(NAME, NAME, _publish, HELP, argv, lasting=True)


def installed(prefixes: str) -> Path | None:
    """Return the program of this name in one of the ament prefixes (separated by `:`) other than the course's."""
    for prefix in filter(None, prefixes.split(os.pathsep)):
        program = Path(prefix, "lib", NAME, NAME)
        if os.access(program, os.X_OK) and program.is_file() and not _is_ours(program):
            return program
    return None


def _is_ours(program: Path) -> bool:
    with program.open("rb") as file:
        return f"-m gz_course.sim.ros.{NAME}.{NAME}".encode() in file.read(1024)


def _publish(node: Node, arguments: list[str]) -> int:
    from gz_course.sim.ros.robot_state_publisher.publisher import DEFAULTS, StatePublisher

    values = read_parameters(node, DEFAULTS)
    if len(arguments) > 1:
        raise UsageError(f"one URDF file can be given, not {len(arguments)}: {' '.join(arguments)}")
    if arguments and arguments[0].startswith("-"):
        raise UsageError(f"there is no option '{arguments[0]}' (see --help)")
    if arguments and values["robot_description"]:
        raise UsageError("the robot is given as a file and in robot_description; give one of them")
    if arguments:
        values["robot_description"] = text_of(Path(arguments[0]))
    if not values["robot_description"].strip():
        raise UsageError("no robot is given; give a URDF file, or its text as the parameter robot_description")
    for name, value in values.items():
        if node.has_parameter(name):
            node.undeclare_parameter(name)
        node.declare_parameter(name, value, ignore_override=True)
    publisher = StatePublisher(node, values)  # nothing else keeps a reference
    code = wait_for_signal(node)
    del publisher
    return code


def text_of(path: Path) -> str:
    """Return the URDF text of a file, expanded if it is xacro. Raises UsageError if it cannot be read."""
    from gz_course.sim.gz.sim.errors import SimError
    from gz_course.sim.gz.sim.sdf.element import parse
    from gz_course.sim.gz.sim.sdf.resources import read_text
    from gz_course.sim.gz.sim.sdf.urdf.xacro_file import restore_places
    from gz_course.sim.gz.sim.sdf.writer import to_xml

    try:
        text = read_text(path)
        if ".xacro" in path.suffixes:
            # Subscribers need a plain URDF, without the line numbers that the reader keeps in it.
            element = parse(text, str(path))
            restore_places(element)
            text = to_xml(element) + "\n"
    except SimError as error:
        raise UsageError(first_line(error)) from None
    return text


if __name__ == "__main__":
    sys.exit(main())
