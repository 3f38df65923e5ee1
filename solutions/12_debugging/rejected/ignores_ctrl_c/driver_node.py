"""Drives up to the wall and stops: takes wall, publishes /cmd_vel."""

import contextlib
import signal

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from sensor_msgs.msg import Range

FASTEST = 0.6  # [m/s]
GAIN = 1.5  # [1/s]
OLDEST = 0.5  # [s] of a distance that is used


class Driver(Node):
    """Drives faster the farther the wall is; stops while it does not know how far that is."""

    def __init__(self):
        super().__init__("driver")
        self.stop_at = self.declare_parameter("stop_at", 1.0).value  # [m]
        self.wall = None
        self.create_subscription(Range, "wall", self.on_wall, 10)
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.05, self.drive)

    def on_wall(self, message):
        self.wall = message

    def drive(self):
        command = Twist()
        if self.wall is not None:
            age = (self.get_clock().now() - Time.from_msg(self.wall.header.stamp)).nanoseconds / 1e9
            if abs(age) < OLDEST:
                left = self.wall.range - self.stop_at
                command.linear.x = max(-FASTEST, min(FASTEST, GAIN * left))
        self.publisher.publish(command)


def main():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Driver())


if __name__ == "__main__":
    main()
