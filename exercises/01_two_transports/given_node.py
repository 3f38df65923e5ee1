"""Patrols the warehouse: drives ahead, turns away from what comes near, and says what it is doing on /patrol/state."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

NEAR = 1.2  # [m]
AHEAD = 0.5  # [rad] to either side


class Patrol(Node):
    """Listens to /scan and /odom, publishes on /cmd_vel and /patrol/state."""

    def __init__(self):
        super().__init__("patrol")
        self.command = self.create_publisher(Twist, "/cmd_vel", 10)
        self.state = self.create_publisher(String, "/patrol/state", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)
        self.speed = 0.0
        self.started = False

    def on_odometry(self, odometry):
        self.speed = odometry.twist.twist.linear.x

    def on_scan(self, scan):
        ahead = [
            distance
            for i, distance in enumerate(scan.ranges)
            if abs(scan.angle_min + i * scan.angle_increment) < AHEAD and math.isfinite(distance)
        ]
        blocked = min(ahead, default=math.inf) < NEAR
        command = Twist()
        command.linear.x = 0.0 if blocked else 0.5
        command.angular.z = 0.6 if blocked else 0.0
        self.command.publish(command)
        if not self.started:
            self.started = True
            self.get_logger().info("on patrol")
        self.state.publish(String(data=f"{'turning' if blocked else 'driving'} at {self.speed:.2f} m/s"))


def main():
    rclpy.init()
    rclpy.spin(Patrol())


if __name__ == "__main__":
    main()
