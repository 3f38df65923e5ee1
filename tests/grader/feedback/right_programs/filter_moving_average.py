"""A moving average over the last values, with deque and a running sum."""

from collections import deque

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Smoother(Node):
    def __init__(self, size=5):
        super().__init__("smoother")
        self.window = deque(maxlen=size)
        self.out = self.create_publisher(Float64, "smooth", 10)
        self.create_subscription(Float64, "raw", self.on_value, 10)

    def on_value(self, message):
        self.window.append(message.data)
        self.out.publish(Float64(data=sum(self.window) / len(self.window)))


def main():
    rclpy.init()
    rclpy.spin(Smoother())


if __name__ == "__main__":
    main()
