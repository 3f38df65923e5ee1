"""Follow a wall at the distance, on the side and within the speed limit that ROS parameters say."""

from math import pi

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

TURN_LIMIT = 1.5  # [rad/s]
BEHIND = 0.8 * pi  # [rad] the wall is looked for from ahead to this bearing


class WallFollower(Node):
    """Hears the lidar on /lidar/scan, and steers the robot with commands on /cmd_vel."""

    def __init__(self):
        super().__init__("wall_follower")
        self.declare_parameter("distance", 0.6)
        self.declare_parameter("side", "left")
        self.declare_parameter("speed_limit", 0.5)
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)

    def on_scan(self, scan):
        wanted = self.get_parameter("distance").value
        limit = self.get_parameter("speed_limit").value
        sign = 1.0 if self.get_parameter("side").value == "left" else -1.0

        ranges = np.array(scan.ranges)
        bearings = sign * (scan.angle_min + scan.angle_increment * np.arange(len(ranges)))
        use = (ranges >= scan.range_min) & (ranges <= scan.range_max) & (bearings >= 0) & (bearings <= BEHIND)
        command = Twist()
        if use.any():
            ranges, bearings = ranges[use], bearings[use]
            nearest = ranges.min()
            # the mean bearing of all that is nearly as near is calmer than that of one ray
            bearing = bearings[ranges < nearest + 0.04].mean()
            error = np.clip(nearest + 0.01 - wanted, -0.45, 0.45)
            turn = np.clip(4.0 * error + 2.6 * (bearing - pi / 2), -TURN_LIMIT, TURN_LIMIT)
        else:
            turn = 0.3  # no wall in sight: look for it
        slow = max(0.25, 1.0 - 0.6 * abs(turn) / TURN_LIMIT)
        if use.any() and bearings[np.argmin(ranges)] < 0.6:
            slow = min(slow, 0.25)
        command.linear.x = max(0.0, float(limit * slow))
        command.angular.z = float(sign * turn)
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
