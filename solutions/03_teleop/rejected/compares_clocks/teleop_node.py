"""Compares the node's clock with the computer's: the start is of this year, the clock at a few seconds."""

import time

import rclpy
from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time

DRIVING_TIME = Duration(seconds=5.0)


class Teleop(Node):
    """Publishes velocity commands on /cmd_vel at 10 Hz of simulated time."""

    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish_command)
        self.start = Time(seconds=time.time(), clock_type=ClockType.ROS_TIME)

    def publish_command(self):
        now = self.get_clock().now()
        command = Twist()
        if now - self.start < DRIVING_TIME:
            command.linear.x = 0.5
            command.angular.z = 0.1
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
