"""Waits in the callback until the log can be read: meanwhile scans come, and most of them are lost."""

import time

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class LidarListener(Node):
    """Answers every scan on /lidar/scan with one log line and one message on /nearest_obstacle."""

    def __init__(self):
        super().__init__("lidar_listener")
        self.nearest = self.create_publisher(Float32, "/nearest_obstacle", 10)
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)

    def on_scan(self, scan):
        time.sleep(0.3)
        valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        if not valid:
            return
        average = sum(valid) / len(valid)
        self.get_logger().info(f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={average:.2f}m")
        self.nearest.publish(Float32(data=min(valid)))


def main():
    rclpy.init()
    rclpy.spin(LidarListener())


if __name__ == "__main__":
    main()
