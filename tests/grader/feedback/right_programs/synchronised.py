"""Two sensors together by their stamps."""

import message_filters
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image, LaserScan


class Together(Node):
    def __init__(self):
        super().__init__("together")
        image = message_filters.Subscriber(self, Image, "/camera")
        scan = message_filters.Subscriber(self, LaserScan, "/scan")
        self.both = message_filters.ApproximateTimeSynchronizer([image, scan], queue_size=10, slop=0.05)
        self.both.registerCallback(self.on_both)

    def on_both(self, image, scan):
        self.get_logger().info(f"{image.width} columns and {len(scan.ranges)} rays")


def main():
    rclpy.init()
    rclpy.spin(Together())


if __name__ == "__main__":
    main()
