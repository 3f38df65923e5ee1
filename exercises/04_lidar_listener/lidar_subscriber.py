"""Report what the lidar sees: statistics on the log, the nearest distance on a topic."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class LidarListener(Node):
    """Subscribes to /lidar/scan."""

    def __init__(self):
        super().__init__("lidar_listener")
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)
        # Your part: a publisher of std_msgs/msg/Float32 on /nearest_obstacle.

    def on_scan(self, scan):
        # Your part: keep the valid ranges, log the line the exercise asks for, publish the smallest range.
        pass


def main():
    rclpy.init()
    rclpy.spin(LidarListener())


if __name__ == "__main__":
    main()
