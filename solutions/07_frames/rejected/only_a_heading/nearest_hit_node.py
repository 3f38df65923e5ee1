"""Calculates on the floor plan: takes a heading out of the quaternion, as if nothing were upside down."""

from collections import deque
from math import atan2, cos, sin

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
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
                transform = self.buffer.lookup_transform("odom", each.header.frame_id, Time.from_msg(each.header.stamp))
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
        q, place = transform.transform.rotation, transform.transform.translation
        angle += atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        hit = PointStamped(header=transform.header)
        hit.point.x = place.x + distance * cos(angle)
        hit.point.y = place.y + distance * sin(angle)
        hit.point.z = place.z
        self.result.publish(hit)


def main():
    rclpy.init()
    rclpy.spin(NearestHit())


if __name__ == "__main__":
    main()
