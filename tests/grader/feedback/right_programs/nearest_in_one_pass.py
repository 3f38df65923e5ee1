#!/usr/bin/env python3
# one pass over the rays, with reduce()
from dataclasses import dataclass
from functools import reduce
from math import inf, isfinite

import rclpy
import rclpy.node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


@dataclass(frozen=True)
class Stats:
    n: int = 0
    total: float = 0.0
    smallest: float = inf

    def __add__(self, r):
        return Stats(self.n + 1, self.total + r, r if r < self.smallest else self.smallest)

    def __str__(self):
        return "Scan: %i valid rays, min=%.3fm, avg=%.3fm" % (self.n, self.smallest, self.total / self.n)


def main():
    rclpy.init()
    node = rclpy.node.Node("lidar_listener")
    nearest = node.create_publisher(Float32, "nearest_obstacle", 10)

    def on_scan(scan):
        ok = (r for r in scan.ranges if isfinite(r) and scan.range_min <= r <= scan.range_max)
        stats = reduce(Stats.__add__, ok, Stats())
        if not stats.n:
            return
        node.get_logger().info(str(stats))
        nearest.publish(Float32(data=stats.smallest))

    node.create_subscription(LaserScan, "lidar/scan", on_scan, 10)
    rclpy.spin(node)


main()
