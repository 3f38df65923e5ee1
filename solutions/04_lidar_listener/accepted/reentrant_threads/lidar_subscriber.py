"""A node whose callbacks may run side by side, and an executor with threads of its own."""

import rclpy
from rclpy import callback_groups
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class LidarListener(Node):
    def __init__(self):
        super().__init__("lidar_threads")
        self.publisher = self.create_publisher(Float32, "/nearest_obstacle", 10)
        group = callback_groups.ReentrantCallbackGroup()
        self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10, callback_group=group)

    def on_scan(self, scan):
        count, total, nearest = 0, 0.0, scan.range_max
        for distance in scan.ranges:
            if scan.range_min <= distance <= scan.range_max:
                count, total, nearest = count + 1, total + distance, min(nearest, distance)
        if count:
            self.get_logger().info(f"Scan: {count} valid rays, min={nearest:.2f}m, avg={total / count:.2f}m")
            self.publisher.publish(Float32(data=nearest))


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(LidarListener())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
