"""A right node for 04_lidar_listener: every answer takes 30 ms, and a scan comes every 100 ms."""

import time

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class LidarListener(Node):
    def __init__(self):
        super().__init__("lidar_slow")
        self.nearest = self.create_publisher(Float32, "/nearest_obstacle", 10)
        self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)

    def on_scan(self, scan):
        valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        time.sleep(0.03)  # in place of a filter that takes its time
        if valid:
            average = sum(valid) / len(valid)
            self.get_logger().info(f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={average:.2f}m")
            self.nearest.publish(Float32(data=min(valid)))


def main():
    rclpy.init()
    rclpy.spin(LidarListener())


if __name__ == "__main__":
    main()
