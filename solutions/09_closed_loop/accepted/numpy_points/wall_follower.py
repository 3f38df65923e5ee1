"""NumPy, a timer of 20 Hz beside the scans, and an executor with threads."""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Follower(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.distance = self.declare_parameter("distance", 0.6)
        self.declare_parameter("side", "left")
        self.declare_parameter("speed_limit", 0.5)
        self.points = np.empty((0, 2))
        self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 5)
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.05, self.steer)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        valid = (ranges > scan.range_min) & (ranges < scan.range_max)
        self.points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles)], axis=1)[valid]

    def steer(self):
        if not len(self.points):
            return
        wanted = self.get_parameter("distance").value
        limit = self.get_parameter("speed_limit").value
        mirror = 1.0 if self.get_parameter("side").value == "left" else -1.0
        ahead, side = self.points[:, 0], mirror * self.points[:, 1]
        ours = (side > -0.1) & (ahead > -1.3 * np.abs(side))
        if not ours.any():
            self.commands.publish(Twist())
            return
        ranges = np.hypot(ahead[ours], side[ours])
        bearings = np.arctan2(side[ours], ahead[ours])
        near = ranges < ranges.min() + 0.05
        psi = bearings[near].mean() - np.pi / 2
        heading = np.clip(1.8 * (ranges.min() - wanted), -0.7, 0.7)
        turn = np.clip(2.2 * (psi + heading), -1.5, 1.5)
        command = Twist()
        command.linear.x = float(limit * np.clip(np.cos(psi), 0.1, 1.0) * (1 - 0.3 * abs(turn)))
        command.angular.z = float(mirror * turn)
        self.commands.publish(command)


rclpy.init()
executor = MultiThreadedExecutor(2)
executor.add_node(Follower())
executor.spin()
