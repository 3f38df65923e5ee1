"""A right node for 04_lidar_listener: reentrant callbacks in an executor with four threads."""

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class LidarListener(Node):
    def __init__(self):
        super().__init__("lidar_reentrant")
        group = ReentrantCallbackGroup()
        self.nearest = self.create_publisher(Float32, "/nearest_obstacle", 10)
        self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10, callback_group=group)
        self.create_timer(0.05, self.look_alive, callback_group=group)
        self.alive = 0

    def look_alive(self):
        self.alive += 1

    def on_scan(self, scan):
        valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        if valid:
            average = sum(valid) / len(valid)
            self.get_logger().info(f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={average:.2f}m")
            self.nearest.publish(Float32(data=min(valid)))


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(LidarListener())
    executor.spin()


if __name__ == "__main__":
    main()
