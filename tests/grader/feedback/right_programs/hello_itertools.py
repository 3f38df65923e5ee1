"""A counter of itertools behind a timer."""

from itertools import count

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Greeter(Node):
    PERIOD = 0.5

    def __init__(self) -> None:
        super().__init__("greeter")
        self._numbers = count(1)
        self._out = self.create_publisher(String, "hello", qos_profile=10)
        self._timer = self.create_timer(self.PERIOD, self._greet)

    def _greet(self) -> None:
        message = String()
        message.data = f"hello {next(self._numbers)}"
        self._out.publish(message)
        self.get_logger().info(message.data)


def main() -> None:
    with rclpy.init():
        rclpy.spin(Greeter())


if __name__ == "__main__":
    main()
