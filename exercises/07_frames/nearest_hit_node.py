"""Say where the nearest obstacle of each scan is, in the frame odom."""

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformListener


class NearestHit(Node):
    """Subscribes to /scan and publishes points on /nearest_hit."""

    def __init__(self):
        super().__init__("nearest_hit")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.result = self.create_publisher(PointStamped, "/nearest_hit", 10)
        self.subscription = self.create_subscription(LaserScan, "/scan", self.on_scan, 10)

    def on_scan(self, scan):
        # Your part: the nearest hit as a point in the frame of the scan, and the transform from there to odom at the
        # time of the scan. It may not be there yet. Publish the point with the time of the scan.
        pass


def main():
    rclpy.init()
    rclpy.spin(NearestHit())


if __name__ == "__main__":
    main()
