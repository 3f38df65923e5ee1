"""Explore rooms that nobody has seen, and map them."""

from math import atan2

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

RESOLUTION = 0.1  # [m] side of a cell
WIDTH, HEIGHT = 100, 80  # [cells] along x and along y
LEFT, BOTTOM = -5.0, -4.0  # [m] the corner of the cell (0, 0) in odom
UNKNOWN, FREE, OCCUPIED = -1, 0, 100


class Mapper(Node):
    """Hears /odom and /scan, publishes /map, and drives by /cmd_vel."""

    def __init__(self):
        super().__init__("mapper")
        self.maps = self.create_publisher(OccupancyGrid, "/map", 10)
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.create_timer(1.0, self.publish_map)
        self.create_timer(0.2, self.drive)
        self.pose = None  # (x [m], y [m], heading [rad]) in odom
        self.scan = None  # the last one
        self.hits = np.zeros((HEIGHT, WIDTH), dtype=int)  # how often a ray ended in a cell; row y, column x
        self.passes = np.zeros((HEIGHT, WIDTH), dtype=int)  # how often a ray passed it

    def on_odom(self, message):
        p, q = message.pose.pose.position, message.pose.pose.orientation
        self.pose = p.x, p.y, 2 * atan2(q.z, q.w)

    def on_scan(self, scan):
        self.scan = scan
        # Your part, 1: count the hits and the passes of this scan. The lidar is above the robot's middle.

    def publish_map(self):
        # Your part, 2: make an OccupancyGrid of hits and passes, with its header and info, and publish it.
        pass

    def drive(self):
        # Your part, 3: publish a Twist. Look at self.scan for what is near, or at the map for what is unknown.
        pass


def main():
    rclpy.init()
    rclpy.spin(Mapper())


if __name__ == "__main__":
    main()
