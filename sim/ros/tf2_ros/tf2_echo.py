"""The program `ros2 run tf2_ros tf2_echo source_frame target_frame [echo_rate]`: prints a transform again and again.

Exit codes: 0 after SIGINT or SIGTERM, 1 without two frames, 2 for a rate that is no number.

Source: tf2_ros/src/tf2_echo.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "tf2_echo"
USAGE = """\
Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame.
Note: This is the transform to get data from target_frame into the source_frame.
Default echo rate is 1 if echo_rate is not given.
"""


def main(argv: list[str] | None = None) -> int:
    """Print until SIGINT or SIGTERM and return the exit code."""
    return run(NAME, NAME, _echo, USAGE, argv, lasting=True)


def _echo(node: Node, arguments: list[str]) -> int:
    from rclpy.clock import Clock, ClockType
    from rclpy.time import Time

    from gz_course.sim.ros.tf2_ros.buffer import Buffer
    from gz_course.sim.ros.tf2_ros.transform_listener import TransformListener

    if not 2 <= len(arguments) <= 3:
        print(USAGE, end="")
        return 1
    try:
        rate = float(arguments[2]) if len(arguments) == 3 else 1.0
    except ValueError:
        print(f"Failed to convert rate argument '{arguments[2]}' to a floating-point number", file=sys.stderr)
        return 2
    if not 0.0 < rate < math.inf:
        print(f"the rate must be more than 0 Hz, not {arguments[2]}", file=sys.stderr)
        return 2
    source, target = arguments[:2]
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node)
    has_begun = False

    def echo() -> None:
        nonlocal has_begun
        possible, why_not = buffer.can_transform_core(source, target, Time())
        if possible:
            has_begun = True
            print(description(buffer.lookup_transform_core(source, target, Time())), flush=True)
        elif not has_begun:
            node.get_logger().info(f"Waiting for transform {source} ->  {target}: {why_not}", throttle_duration_sec=1.0)
        else:
            now = node.get_clock().now().nanoseconds * 1e-9
            print(
                f"Failure at {now:f}\nException thrown:{why_not}\n"
                f"The current list of frames is:\n{buffer.all_frames_as_string()}",
                flush=True,
            )

    timer = node.create_timer(1.0 / rate, echo, clock=Clock(clock_type=ClockType.STEADY_TIME))
    code = wait_for_signal(node)
    del timer, listener
    return code


def description(message: Any) -> str:
    """Return the lines about a transform: time, translation, rotation as quaternion and Euler angles, matrix."""
    stamp, place, turn = message.header.stamp, message.transform.translation, message.transform.rotation
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), place.x),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), place.y),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), place.z),
        (0.0, 0.0, 0.0, 1.0),
    )
    angles = (
        math.atan2(rows[2][1], rows[2][2]),
        math.asin(max(-1.0, min(1.0, -rows[2][0]))),
        math.atan2(rows[1][0], rows[0][0]),
    )
    return "\n".join(
        [
            f"At time {stamp.sec}.{stamp.nanosec:09d}" if stamp.nanosec else f"At time {stamp.sec}.0",
            f"- Translation: {_listed(place.x, place.y, place.z)}",
            f"- Rotation: in Quaternion {_listed(x, y, z, w)}",
            f"- Rotation: in RPY (radian) {_listed(*angles)}",
            f"- Rotation: in RPY (degree) {_listed(*map(math.degrees, angles))}",
            "- Matrix:",
            *("".join(f" {number:6.3f}" for number in row) for row in rows),
        ]
    )


def _listed(*numbers: float) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


if __name__ == "__main__":
    sys.exit(main())
