"""Follow a wall at the distance, on the side and within the speed limit that ROS parameters say."""

from math import cos, isfinite, pi

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

APPROACH_GAIN = 2.0  # [rad] of heading towards the wall for each metre too far from it
STEEPEST = 0.7  # [rad] of that heading
HEADING_GAIN = 2.0  # [rad/s] for each radian of the wrong heading
MOST_TURNING = 1.5  # [rad/s]
TICK = 0.02  # [s]
ABOUT_AS_NEAR = 0.04  # [m] noise of the lidar, and a little


def limited(value, most):
    """Return the value, or the nearest that is not beyond -most and most."""
    return max(-most, min(most, value))


class WallFollower(Node):
    """Steers by the nearest point of the wall on its side: that point should be abeam, at the wanted distance."""

    def __init__(self):
        super().__init__("wall_follower")
        self.declare_parameter("distance", 0.6)
        self.declare_parameter("speed_limit", 0.5)
        self.declare_parameter("side", "left")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)
        self.left_to_turn = 0  # ticks
        self.timer = self.create_timer(TICK, self.on_tick)

    def on_tick(self):
        """Turn by a right angle in a corner, as long as that takes."""
        if self.left_to_turn > 0:
            self.left_to_turn -= 1
            command = Twist()
            command.angular.z = -1.0 if self.get_parameter("side").value == "left" else 1.0
            self.publisher.publish(command)

    def on_scan(self, scan):
        if self.left_to_turn > 0:
            return
        ahead = [d for i, d in enumerate(scan.ranges) if abs(scan.angle_min + i * scan.angle_increment) < 0.1]
        if min(ahead) < self.get_parameter("distance").value:
            self.left_to_turn = round(pi / 2 / 1.0 / TICK)
            return
        wanted = self.get_parameter("distance").value
        limit = self.get_parameter("speed_limit").value
        sign = 1.0 if self.get_parameter("side").value == "left" else -1.0

        rays = []  # (range, bearing) of the valid rays on the side; bearings grow from ahead towards the side
        for i, distance in enumerate(scan.ranges):
            bearing = sign * (scan.angle_min + i * scan.angle_increment)
            if -0.2 < bearing < 0.8 * pi and isfinite(distance) and scan.range_min < distance < scan.range_max:
                rays.append((distance, bearing))
        command = Twist()
        if rays:
            nearest = min(rays)[0]
            near = [bearing for distance, bearing in rays if distance < nearest + ABOUT_AS_NEAR]
            away = sum(near) / len(near) - pi / 2  # heading away from the wall
            towards = limited(APPROACH_GAIN * (nearest - wanted), STEEPEST)
            turning = limited(HEADING_GAIN * (away + towards), MOST_TURNING)
            command.linear.x = limit * max(0.1, cos(away)) * (1 - 0.5 * abs(turning) / MOST_TURNING)
            command.angular.z = sign * turning
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
