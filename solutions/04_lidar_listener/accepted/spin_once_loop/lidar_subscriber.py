"""Keeps the latest scan and works on it in a loop of its own around spin_once."""

import math

import rclpy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class Latest:
    scan = None

    def keep(self, scan):
        self.scan = scan


def main():
    rclpy.init()
    node = rclpy.create_node("lidar_loop")
    publisher = node.create_publisher(Float32, "/nearest_obstacle", 10)
    latest = Latest()
    node.create_subscription(LaserScan, "/lidar/scan", latest.keep, 10)
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.1)
        scan, latest.scan = latest.scan, None
        if scan is None:
            continue
        valid = [r for r in scan.ranges if math.isfinite(r) and scan.range_min <= r <= scan.range_max]
        if valid:
            line = f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={math.fsum(valid) / len(valid):.2f}m"
            node.get_logger().warn(line)
            publisher.publish(Float32(data=min(valid)))


if __name__ == "__main__":
    main()
