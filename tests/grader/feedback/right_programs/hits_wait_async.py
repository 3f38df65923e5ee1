#!/usr/bin/env python3
# No queue of my own: the buffer says when the transform is there.
import math

import rclpy
import tf2_geometry_msgs  # noqa: F401  (teaches tf2 about PointStamped)
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformListener


def nearest(scan):
    """(distance, angle) of the nearest hit, or None."""
    hits = [
        (r, scan.angle_min + k * scan.angle_increment)
        for k, r in enumerate(scan.ranges)
        if scan.range_min <= r <= scan.range_max
    ]
    return min(hits) if hits else None


class NearestHitNode(Node):
    TARGET = "odom"

    def __init__(self):
        super().__init__("nearest_hit")
        self.tf = Buffer()
        self.tf_listener = TransformListener(self.tf, self)
        self.pub = self.create_publisher(PointStamped, "nearest_hit", 10)
        self.sub = self.create_subscription(LaserScan, "scan", self.scan_cb, 10)

    def scan_cb(self, scan):
        hit = nearest(scan)
        if hit is None:
            return
        r, a = hit
        p = PointStamped(header=scan.header)
        p.point.x, p.point.y = r * math.cos(a), r * math.sin(a)
        when = Time.from_msg(scan.header.stamp)
        ready = self.tf.wait_for_transform_async(self.TARGET, p.header.frame_id, when)
        ready.add_done_callback(lambda _: self.pub.publish(self.tf.transform(p, self.TARGET)))


def main():
    rclpy.init()
    rclpy.spin(NearestHitNode())


if __name__ == "__main__":
    main()
