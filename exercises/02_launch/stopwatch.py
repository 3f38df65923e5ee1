"""Given: a node that says every 0.1 s on /stopwatch, in seconds, what time it is. Whose time, its parameters decide."""

import contextlib

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float64


class Stopwatch(Node):
    """Publishes the time of its own clock."""

    def __init__(self):
        super().__init__("stopwatch")
        self.publisher = self.create_publisher(Float64, "/stopwatch", 10)
        self.timer = self.create_timer(0.1, self.tell)

    def tell(self):
        self.publisher.publish(Float64(data=self.get_clock().now().nanoseconds / 1e9))


def main():
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Stopwatch())


if __name__ == "__main__":
    main()
