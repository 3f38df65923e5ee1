"""Sleeps for a second before it speaks: others find the publisher meanwhile. It works, but nothing else can happen."""

import time

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Hello(Node):
    """Publishes one std_msgs/msg/String on /hello."""

    def __init__(self):
        super().__init__("hello")
        self.publisher = self.create_publisher(String, "/hello", 10)
        time.sleep(1.0)
        self.publisher.publish(String(data="hello, robot"))


def main():
    rclpy.init()
    rclpy.spin(Hello())


if __name__ == "__main__":
    main()
