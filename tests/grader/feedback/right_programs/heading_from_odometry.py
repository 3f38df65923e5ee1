"""The heading of a robot, in degrees, from its odometry."""

import math

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float64


def yaw_of(q) -> float:
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


class Compass(Node):
    def __init__(self):
        super().__init__("compass")
        self.out = self.create_publisher(Float64, "/heading_deg", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)

    def on_odometry(self, message):
        self.out.publish(Float64(data=math.degrees(yaw_of(message.pose.pose.orientation))))


def main():
    rclpy.init()
    rclpy.spin(Compass())


if __name__ == "__main__":
    main()
