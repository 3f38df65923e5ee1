"""Takes the latest transform, Time(), which is older than the scan."""

from collections import deque
from math import cos, sin

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_geometry_msgs import do_transform_point
from tf2_ros import Buffer, TransformException, TransformListener


class NearestHit(Node):
    """Subscribes to /scan and publishes points on /nearest_hit."""

    def __init__(self):
        super().__init__("nearest_hit")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.result = self.create_publisher(PointStamped, "/nearest_hit", 10)
        self.subscription = self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.waiting = deque(maxlen=5)

    def on_scan(self, scan):
        self.waiting.append(scan)
        for each in list(self.waiting):
            try:
                transform = self.buffer.lookup_transform("odom", each.header.frame_id, Time())
            except TransformException:
                continue  # not there yet
            self.waiting.remove(each)
            self.publish_nearest(each, transform)

    def publish_nearest(self, scan, transform):
        hits = [(r, i) for i, r in enumerate(scan.ranges) if scan.range_min < r < scan.range_max]
        if not hits:
            return
        distance, ray = min(hits)
        angle = scan.angle_min + ray * scan.angle_increment
        hit = PointStamped(header=scan.header)
        hit.point.x = distance * cos(angle)
        hit.point.y = distance * sin(angle)
        done = do_transform_point(hit, transform)
        done.header.stamp = scan.header.stamp
        self.result.publish(done)


def main():
    rclpy.init()
    rclpy.spin(NearestHit())


if __name__ == "__main__":
    main()
