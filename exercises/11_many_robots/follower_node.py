"""Follows another robot: drives to the place `gap` metres behind it."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class Follower(Node):
    """Hears the odometry of its own robot and of the one in front, and steers its own robot."""

    def __init__(self):
        super().__init__("follower")
        self.gap = self.declare_parameter("gap", 1.2).value  # [m] from robot to robot
        self.own = None
        self.front = None
        # Your part: with these names, all followers steer the same robot, and none hears the robot in front of its own.
        self.publisher = self.create_publisher(Twist, "/robot2/cmd_vel", 10)
        self.create_subscription(Odometry, "/robot2/odom", self.on_own, 10)
        self.create_subscription(Odometry, "/robot2/odom", self.on_front, 10)
        self.create_timer(0.1, self.steer)

    def on_own(self, message):
        self.own = message.pose.pose

    def on_front(self, message):
        self.front = message.pose.pose

    def steer(self):
        if self.own is None or self.front is None:
            return
        # Odometry begins where its robot began: the robot in front began `gap` ahead of this one.
        ahead = self.front.position.x + self.gap - self.own.position.x
        aside = self.front.position.y - self.own.position.y
        heading = 2 * math.atan2(self.own.orientation.z, self.own.orientation.w)
        distance = math.hypot(ahead, aside)
        turn = math.remainder(math.atan2(aside, ahead) - heading, math.tau)
        command = Twist()
        command.linear.x = max(0.0, min(0.8, 1.5 * (distance - self.gap)))
        command.angular.z = max(-1.5, min(1.5, 2.0 * turn))
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Follower())


if __name__ == "__main__":
    main()
