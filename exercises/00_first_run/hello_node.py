"""Say hello to the robot: one message on /hello, one second after the start."""

import rclpy
from rclpy.node import Node


class Hello(Node):
    """Publishes one std_msgs/msg/String on /hello."""

    def __init__(self):
        super().__init__("hello")
        # Your part: a publisher of std_msgs/msg/String on /hello.
        self.timer = self.create_timer(1.0, self.say_hello)

    def say_hello(self):
        # Your part: publish a String whose data is "hello, robot".
        self.timer.cancel()  # once is enough


def main():
    rclpy.init()
    rclpy.spin(Hello())


if __name__ == "__main__":
    main()
