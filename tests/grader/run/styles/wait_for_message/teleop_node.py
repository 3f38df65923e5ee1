"""A right node for 03_teleop: waits for the first odometry before it begins to drive."""

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message


class Teleop(Node):
    def __init__(self, odometry):
        super().__init__("teleop_waits")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish_command)
        self.first = odometry
        self.start = None

    def publish_command(self):
        now = self.get_clock().now()
        self.start = self.start or now
        command = Twist()
        if now - self.start < Duration(seconds=5):
            command.linear.x = 0.5
            command.angular.z = 0.1 + 0.02 * (now - self.start).nanoseconds / 1e9
        self.publisher.publish(command)


def main():
    rclpy.init()
    waiting = rclpy.create_node("waits_for_odometry")
    found, odometry = wait_for_message(Odometry, waiting, "/odom", time_to_wait=30)
    waiting.destroy_node()
    if found:
        rclpy.spin(Teleop(odometry))


if __name__ == "__main__":
    main()
