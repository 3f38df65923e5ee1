"""Drive to a point with a turn before the way, errors wrapped into half a turn."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node

GOAL = (2.0, 1.0)


def wrapped(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


def clamp(value, low, high):
    return min(max(value, low), high)


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot")
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.steer, 10)

    def steer(self, odometry):
        position, q = odometry.pose.pose.position, odometry.pose.pose.orientation
        heading = 2.0 * math.atan2(q.z, q.w)
        dx, dy = GOAL[0] - position.x, GOAL[1] - position.y
        command = Twist()
        if math.hypot(dx, dy) > 0.05:
            error = wrapped(math.atan2(dy, dx) - heading)
            command.angular.z = clamp(2.0 * error, -1.0, 1.0)
            if abs(error) < 0.3:
                command.linear.x = clamp(0.8 * math.hypot(dx, dy), 0.0, 0.5)
        self.commands.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Pilot())


if __name__ == "__main__":
    main()
