"""The program `ros2 run teleop_twist_keyboard teleop_twist_keyboard`: publishes a Twist on `cmd_vel` for each key.

Parameters: `stamped` (publish TwistStamped), `frame_id` (of its header), `speed` [m/s], `turn` [rad/s], `repeat_rate`
[Hz] (publish again and again, 0: once per key), `key_timeout` [s] (stop without a key for so long, 0: never). The last
four are those of ROS 1; the package of Jazzy passes over them.

Whatever ends it, the terminal is as before and the robot has been told to stop. Exit codes: 0 after Ctrl-C, SIGINT,
SIGTERM or a closed window, 1 without a terminal, 2 for unusable parameters.

Source: https://github.com/ros2/teleop_twist_keyboard
Source: https://github.com/ros-teleop/teleop_twist_keyboard (README.md: parameters)
"""

from __future__ import annotations

import math
import os
import signal
import sys
import time
from types import FrameType
from typing import TYPE_CHECKING, Any

from gz_course.sim.postponed_signal import postponed
from gz_course.sim.ros.ros_program.errors import UsageError
from gz_course.sim.ros.ros_program.parameters import read_parameters
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import Spinner
from gz_course.sim.show.teleop_twist_keyboard.keys import END, HELP, STOP, Command
from gz_course.sim.show.teleop_twist_keyboard.terminal import Keys

if TYPE_CHECKING:
    from rclpy.node import Node

NAME = "teleop_twist_keyboard"
DEFAULTS = {"stamped": False, "frame_id": "", "speed": 0.5, "turn": 1.0, "repeat_rate": 0.0, "key_timeout": 0.0}
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
LAST_WORD_S = 5.0  # [s] for the robot to take the last message
USAGE = f"""\
usage: {NAME} [--ros-args -r cmd_vel:=/TOPIC -p stamped:=true -p frame_id:=base_link ...]

{HELP}
parameters: {", ".join(DEFAULTS)}
"""


def main(argv: list[str] | None = None) -> int:
    """Publish until Ctrl-C and return the exit code."""
    words = sys.argv[1:] if argv is None else argv
    if not {"-h", "--help", "-help"} & set(words) and not os.isatty(0):
        print(
            f"{NAME}: standard input is not a terminal, so there are no keys to read; start me in a terminal of my "
            "own, neither in a pipe nor from a launch file",
            file=sys.stderr,
        )
        return 1
    return run(NAME, NAME, _teleop, USAGE, argv)


def _teleop(node: Node, arguments: list[str]) -> int:
    driver = Driver(node, checked(read_parameters(node, DEFAULTS)))
    for number in ENDS:
        signal.signal(number, _end)
    try:
        with Keys(0) as keys, Spinner(node):
            try:
                print(HELP)
                print(driver.command, flush=True)
                driver.drive(keys)
            finally:
                driver.stop()
    except (KeyboardInterrupt, OSError):  # the latter: the window was closed, nothing can be printed
        pass
    return 0


def checked(values: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters. Raises UsageError if they make no sense."""
    if values["frame_id"] and not values["stamped"]:
        raise UsageError("the parameter frame_id is of use only with stamped:=true; a Twist has no header")
    for name in ("speed", "turn", "repeat_rate", "key_timeout"):
        if not 0.0 <= values[name] < math.inf:
            raise UsageError(f"the parameter {name} must be a number of 0 or more, not {values[name]}")
    return values


def _end(number: int, frame: FrameType | None) -> None:
    if postponed(number, frame):
        return
    for each in ENDS:  # a second signal must not interrupt the last message
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


class Driver:
    """Publishes what the keys ask for on the node's topic `cmd_vel`."""

    def __init__(self, node: Node, values: dict[str, Any]) -> None:
        from geometry_msgs.msg import Twist, TwistStamped

        self.command = Command(values["speed"], values["turn"])
        self._node = node
        self._frame_id = values["frame_id"]
        self._type = TwistStamped if values["stamped"] else Twist
        self._period = 1.0 / values["repeat_rate"] if values["repeat_rate"] else math.inf
        self._patience = values["key_timeout"] or math.inf
        self._publisher = node.create_publisher(self._type, "cmd_vel", 10)
        self._was_heard = True

    def drive(self, keys: Keys) -> None:
        """Follow the keys until Ctrl-C, or until the terminal is closed."""
        silent_at = again_at = math.inf  # when to stop the robot, and when to publish without a key
        while True:
            wait = min(silent_at, again_at) - time.monotonic()
            pressed = keys.pressed(None if wait == math.inf else max(0.0, wait))
            if pressed is None:
                return
            now = time.monotonic()
            for key in pressed:
                if key == END:
                    return
                if self.command.press(key):
                    print(self.command, flush=True)
                self.publish()
            if pressed:
                silent_at, again_at = now + self._patience, now + self._period
            elif now >= silent_at:
                silent_at = math.inf
                self.command.direction = STOP
                self.publish()
            elif now >= again_at:
                again_at = now + self._period
                self.publish()

    def publish(self) -> None:
        message = self._type()
        twist = message
        if hasattr(message, "header"):
            message.header.stamp = self._node.get_clock().now().to_msg()
            message.header.frame_id = self._frame_id
            twist = message.twist
        twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z = self.command.velocity
        self._publisher.publish(message)
        is_heard = self._publisher.get_subscription_count() > 0
        if self._was_heard and not is_heard:
            print(f"nobody has subscribed to {self._publisher.topic_name} ({self._type.__name__}) yet", flush=True)
        self._was_heard = is_heard

    def stop(self) -> None:
        """Publish zero, and wait until it has arrived, a short time at most."""
        from rclpy.duration import Duration

        self.command.direction = STOP
        self.publish()
        self._publisher.wait_for_all_acked(Duration(seconds=LAST_WORD_S))


if __name__ == "__main__":
    sys.exit(main())
