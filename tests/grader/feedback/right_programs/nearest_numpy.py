"""The smallest valid range by NumPy masks."""

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64


class Nearest(Node):
    def __init__(self):
        super().__init__("nearest")
        self.result = self.create_publisher(Float64, "/nearest", 10)
        self.create_subscription(LaserScan, "/lidar/scan", self.take, 10)

    def take(self, scan: LaserScan):
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        good = np.isfinite(ranges) & (ranges > scan.range_min) & (ranges < scan.range_max)
        if good.any():
            self.result.publish(Float64(data=float(ranges[good].min())))


def main():
    rclpy.init()
    rclpy.spin(Nearest())


if __name__ == "__main__":
    main()
