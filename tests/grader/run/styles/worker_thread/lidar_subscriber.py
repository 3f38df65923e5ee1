"""A right node for 04_lidar_listener: the callback queues the scan, a thread of its own answers it."""

import queue
import threading

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class LidarListener(Node):
    def __init__(self):
        super().__init__("lidar_worker")
        self.scans = queue.Queue()
        self.nearest = self.create_publisher(Float32, "/nearest_obstacle", 10)
        self.create_subscription(LaserScan, "/lidar/scan", self.scans.put, 10)
        threading.Thread(target=self.work, daemon=True).start()

    def work(self):
        while True:
            scan = self.scans.get()
            valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
            if valid:
                average = sum(valid) / len(valid)
                self.get_logger().info(f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={average:.2f}m")
                self.nearest.publish(Float32(data=min(valid)))


def main():
    rclpy.init()
    rclpy.spin(LidarListener())


if __name__ == "__main__":
    main()
