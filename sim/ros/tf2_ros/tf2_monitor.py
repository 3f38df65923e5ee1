"""The program `ros2 run tf2_ros tf2_monitor [framea frameb]`: how often transforms come, and how late.

It reports every 10 s on all frames, or on those between two. Exit codes: 0 after SIGINT or SIGTERM, 1 for unusable
arguments.

Source: tf2_ros/src/tf2_monitor.cpp of https://github.com/ros2/geometry2
"""

from __future__ import annotations

import sys
from collections import deque
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node

    from gz_course.sim.ros.tf2_ros.buffer import Buffer

NAME = "tf2_monitor"
USAGE = """\
usage: tf2_monitor [framea frameb]

Reports every 10 seconds how often transforms are published and how old they are when they come,
of all frames or of those between framea and frameb.
"""
_LOOK_S = 0.5  # [s] between two looks at the chain
_LOOKS = 20  # in a report
_KEPT = 1000  # numbers of which an average is taken
_PUBLISHER = "<no authority available>"  # DDS tells no name with a message


class Monitor:
    """What was heard of the transforms of a node's `/tf` and `/tf_static`; `chain` holds two frames or none."""

    def __init__(self, node: Node, buffer: Buffer, chain: tuple[str, str] | None) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from tf2_msgs.msg import TFMessage

        self._clock = node.get_clock()
        self._buffer = buffer
        self._ends = chain
        self._chain: list[str] = []
        self._looks = 0
        self._average, self._largest = 0.0, 0.0
        self._frames: dict[str, deque[float]] = {}
        self._delays: deque[float] = deque(maxlen=_KEPT)
        self._times: deque[float] = deque(maxlen=_KEPT)
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(TFMessage, "/tf", self.take, QoSProfile(depth=100))
        node.create_subscription(TFMessage, "/tf_static", self.take_static, latched)

    def take(self, message: Any) -> None:
        """Count a message, and how old its transforms are."""
        now = self._now()
        self._count(message, now, [now - _seconds(each.header.stamp) for each in message.transforms])

    def take_static(self, message: Any) -> None:
        """Count a message; what always holds is never late."""
        self._count(message, self._now(), [0.0] * len(message.transforms))

    def _count(self, message: Any, now: float, delays: list[float]) -> None:
        for transform, delay in zip(message.transforms, delays, strict=True):
            self._frames.setdefault(transform.child_frame_id, deque(maxlen=_KEPT)).append(delay)
        self._delays.append(sum(delays) / max(1, len(delays)))
        self._times.append(now)

    def look(self) -> None:
        """Measure the delay of the chain; print a report at every twentieth call."""
        from rclpy.time import Time

        if self._ends is not None:
            first, second = self._ends
            if not self._buffer.can_transform_core(first, second, Time())[0]:
                if not self._chain:
                    print(".", end="", flush=True)
                    return
            else:
                if not self._chain:
                    print(flush=True)
                    self._chain = self._buffer._chain(second, Time(), first, Time(), second)
                stamp = self._buffer.lookup_transform_core(first, second, Time()).header.stamp
                delay = self._now() - _seconds(stamp) if _seconds(stamp) else 0.0
                self._average = 0.01 * delay + 0.99 * self._average
                self._largest = max(self._largest, delay)
        self._looks += 1
        if self._looks == _LOOKS:
            self._looks = 0
            print(self.report(), flush=True)

    def report(self) -> str:
        """Return the report on everything that was counted so far."""
        frames = sorted(self._frames)
        if self._ends is None:
            lines = ["", "", "", "RESULTS: for all Frames"]
        else:
            frames = [frame for frame in frames if frame in self._chain]
            lines = ["", "", "", f"RESULTS: for {self._ends[0]} to {self._ends[1]}"]
            lines.append(f"Chain is: {' -> '.join(self._chain)}")
            lines.append(f"Net delay     avg = {self._average:g}: max = {self._largest:g}")
        lines += ["", "Frames:"]
        for frame in frames:
            average, largest = _delay(self._frames[frame])
            lines.append(
                f"Frame: {frame}, published by {_PUBLISHER}, Average Delay: {average:g}, Max Delay: {largest:g}"
            )
        lines += ["", "All Broadcasters:"]
        if self._times:
            average, largest = _delay(self._delays)
            rate = len(self._times) / max(1e-8, self._times[-1] - self._times[0])
            lines.append(f"Node: {_PUBLISHER} {rate:g} Hz, Average Delay: {average:g} Max Delay: {largest:g}")
        return "\n".join(lines)

    def _now(self) -> float:
        return float(self._clock.now().nanoseconds * 1e-9)


def _seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec * 1e-9)


def _delay(delays: deque[float]) -> tuple[float, float]:
    return sum(delays) / len(delays), max(0.0, *delays)


def main(argv: list[str] | None = None) -> int:
    """Report until SIGINT or SIGTERM and return the exit code."""
    return run(NAME, NAME, _monitor, USAGE, argv, lasting=True)


def _monitor(node: Node, arguments: list[str]) -> int:
    from rclpy.clock import Clock, ClockType

    from gz_course.sim.ros.tf2_ros.buffer import Buffer
    from gz_course.sim.ros.tf2_ros.transform_listener import TransformListener

    if len(arguments) not in (0, 2):
        print("TF_Monitor: usage: tf2_monitor framea frameb")
        return 1
    buffer = Buffer(node=node)
    listener = TransformListener(buffer, node)
    if arguments:
        chain = (arguments[0], arguments[1])
        print(f"Waiting for transform chain to become available between {chain[0]} and {chain[1]} ", end="", flush=True)
        monitor = Monitor(node, buffer, chain)
    else:
        print("Gathering data on all frames for 10 seconds...", flush=True)
        monitor = Monitor(node, buffer, None)
    timer = node.create_timer(_LOOK_S, monitor.look, clock=Clock(clock_type=ClockType.STEADY_TIME))
    code = wait_for_signal(node)
    del timer, listener
    return code


if __name__ == "__main__":
    sys.exit(main())
