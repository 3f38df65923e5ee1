"""Adds the timer's period at each tick and takes the sum for the time, as many a textbook does."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Teleop(Node):
    """Publishes velocity commands on /cmd_vel."""

    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish_command)
        self.elapsed = 0.0

    def publish_command(self):
        command = Twist()
        if self.elapsed < 5.0:
            command.linear.x = 0.5
            command.angular.z = 0.1
        self.publisher.publish(command)
        self.elapsed += 0.1


def main():
    rclpy.init()
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
