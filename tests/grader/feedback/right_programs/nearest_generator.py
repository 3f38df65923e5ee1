"""The smallest valid range by a generator expression with a default."""

import math

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64


def valid(scan):
    return (r for r in scan.ranges if math.isfinite(r) and scan.range_min < r < scan.range_max)


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.pub = self.create_publisher(Float64, "minimum", 10)
        self.sub = self.create_subscription(
            LaserScan, "lidar/scan", lambda scan: self.answer(min(valid(scan), default=None)), 10
        )

    def answer(self, smallest):
        if smallest is None:
            return
        self.pub.publish(Float64(data=smallest))


def main():
    rclpy.init()
    rclpy.spin(Listener())


if __name__ == "__main__":
    main()
