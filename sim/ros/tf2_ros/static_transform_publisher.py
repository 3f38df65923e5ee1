"""The program `ros2 run tf2_ros static_transform_publisher --x 1 --frame-id map --child-frame-id odom`.

The old arguments are taken, too: `x y z yaw pitch roll frame child`, or `x y z qx qy qz qw frame child`. Exit codes: 0
after SIGINT or SIGTERM, 1 for unusable arguments.

Source: tf2_ros/src/static_transform_broadcaster_program.cpp and static_transform_broadcaster_node.cpp of
https://github.com/ros2/geometry2
"""

from __future__ import annotations

import math
import secrets
import sys
from typing import TYPE_CHECKING

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros_program.errors import Failure
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "static_transform_publisher"
USAGE = """\
usage: static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW] \
[--roll ROLL] [--pitch PITCH] [--yaw YAW] --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID

Publishes one transform on /tf_static until it is stopped; without numbers the identity.

required arguments:
  --frame-id FRAME_ID                parent frame
  --child-frame-id CHILD_FRAME_ID    child frame

optional arguments:
  --x X, --y Y, --z Z                translation in metres
  --roll ROLL, --pitch PITCH, --yaw YAW
                                     rotation as Euler angles in radians, or
  --qx QX, --qy QY, --qz QZ, --qw QW
                                     as a quaternion
"""
_TRANSLATION = ("x", "y", "z")
_EULER = ("roll", "pitch", "yaw")
_QUATERNION = ("qx", "qy", "qz", "qw")
_FRAMES = ("frame-id", "child-frame-id")
_OPTIONS = (*_TRANSLATION, *_QUATERNION, *_EULER, *_FRAMES)
# Without flags, by their number.
_OLD_STYLES = {
    8: ("x", "y", "z", "yaw", "pitch", "roll", *_FRAMES),
    9: (*_TRANSLATION, *_QUATERNION, *_FRAMES),
}


class StaticTransform:
    """The transform that the arguments of the command line describe. Raises Failure for unusable ones."""

    def __init__(self, arguments: list[str]) -> None:
        texts, rest = _flags(arguments)
        self.is_old_style = len(rest) in _OLD_STYLES
        if self.is_old_style:
            if texts:
                raise Failure("Cannot specify both new-style (flags) and old-style (arguments)")
            texts = dict(zip(_OLD_STYLES[len(rest)], rest, strict=True))
        elif rest:
            raise Failure(f"Extra unparsed arguments on command-line: {' '.join(rest)}{_hint(rest[0])}")
        if set(texts) & set(_EULER) and set(texts) & set(_QUATERNION):
            raise Failure("Cannot specify both quaternion and Euler rotations")
        self.frame_id, self.child_frame_id = (texts.pop(name, "") for name in _FRAMES)
        for name, value in (("Frame id", self.frame_id), ("Child frame id", self.child_frame_id)):
            if not value:
                raise Failure(f"{name} must not be empty")
        if self.frame_id == self.child_frame_id:
            raise Failure(f"cannot publish static transform from '{self.frame_id}' to '{self.child_frame_id}', exiting")
        numbers = {name: _number(name, text) for name, text in texts.items()}
        x, y, z = (numbers.get(name, 0.0) for name in _TRANSLATION)
        self.translation = x, y, z
        if set(numbers) & set(_EULER):
            roll, pitch, yaw = (numbers.get(name, 0.0) for name in _EULER)
            self.rotation = quaternion(roll, pitch, yaw)
        else:
            qx, qy, qz = (numbers.get(name, 0.0) for name in _QUATERNION[:3])
            self.rotation = qx, qy, qz, numbers.get("qw", 1.0)
            if not any(self.rotation):
                raise Failure("the quaternion 0 0 0 0 is no rotation; no rotation at all is 0 0 0 1")

    def parameters(self) -> dict[str, float | str]:
        """Return the values by the names of the node's parameters."""
        return {
            **{f"translation.{name}": value for name, value in zip("xyz", self.translation, strict=True)},
            **{f"rotation.{name}": value for name, value in zip("xyzw", self.rotation, strict=True)},
            "frame_id": self.frame_id,
            "child_frame_id": self.child_frame_id,
        }


def quaternion(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return the quaternion (x, y, z, w) of a rotation about the fixed axes x, y and z, in this order [rad]."""
    sr, sp, sy = (math.sin(angle / 2.0) for angle in (roll, pitch, yaw))
    cr, cp, cy = (math.cos(angle / 2.0) for angle in (roll, pitch, yaw))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def _flags(arguments: list[str]) -> tuple[dict[str, str], list[str]]:
    """Return the values of the flags by their names, and the arguments that belong to no flag."""
    texts: dict[str, str] = {}
    rest: list[str] = []
    words = iter(arguments)
    for word in words:
        name = word.removeprefix("--")
        if word == name or name not in _OPTIONS:
            rest.append(word)
            continue
        value = next(words, None)
        if value is None:
            raise Failure(f"Not enough arguments for {word}")
        texts[name] = value
    return texts, rest


def _hint(word: str) -> str:
    return did_you_mean(word, [f"--{name}" for name in _OPTIONS]) if word.startswith("--") else ""


def _number(name: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise Failure(f"Failed to parse {name} argument as float: {text}") from None
    if not math.isfinite(number):
        raise Failure(f"{name} must be a finite number, not {text}")
    return number


def main(argv: list[str] | None = None) -> int:
    """Publish until SIGINT or SIGTERM and return the exit code."""
    return run(NAME, f"{NAME}_{secrets.token_hex(8)}", _publish, USAGE, argv, lasting=True)


def _publish(node: Node, arguments: list[str]) -> int:
    from geometry_msgs.msg import TransformStamped
    from rcl_interfaces.msg import ParameterDescriptor

    from gz_course.sim.ros.tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster

    try:
        given = StaticTransform(arguments)
    except Failure as error:
        print(f"error parsing command line arguments: {error}\n{USAGE}", end="", file=sys.stderr)
        return 1
    if given.is_old_style:
        node.get_logger().warning("Old-style arguments are deprecated; see --help for new-style arguments")
    for name, value in given.parameters().items():
        if not node.has_parameter(name):
            node.declare_parameter(name, value, ParameterDescriptor(read_only=True), ignore_override=True)
    message = TransformStamped(child_frame_id=given.child_frame_id)
    message.header.frame_id = given.frame_id
    message.header.stamp = node.get_clock().now().to_msg()
    place, turn = message.transform.translation, message.transform.rotation
    place.x, place.y, place.z = given.translation
    turn.x, turn.y, turn.z, turn.w = given.rotation
    StaticTransformBroadcaster(node).sendTransform(message)
    node.get_logger().info(
        f"Spinning until stopped - publishing transform\ntranslation: ({_quoted(given.translation)})\n"
        f"rotation: ({_quoted(given.rotation)})\nfrom '{given.frame_id}' to '{given.child_frame_id}'"
    )
    return wait_for_signal(node)


def _quoted(numbers: tuple[float, ...]) -> str:
    return ", ".join(f"'{number:f}'" for number in numbers)


if __name__ == "__main__":
    sys.exit(main())
