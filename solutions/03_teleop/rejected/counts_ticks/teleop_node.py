"""Counts fifty ticks and believes they are five seconds, whatever the rate of the timer."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

TICKS = 50


class Teleop(Node):
    """Publishes velocity commands on /cmd_vel."""

    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.05, self.publish_command)
        self.ticks = 0

    def publish_command(self):
        command = Twist()
        self.ticks += 1
        if self.ticks <= TICKS:
            command.linear.x = 0.5
            command.angular.z = 0.1
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
