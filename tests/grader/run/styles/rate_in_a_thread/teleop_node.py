"""A right node for 03_teleop: a thread of its own drives, at a Rate of 20 Hz; the main thread spins."""

import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop_rate")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.rate = self.create_rate(20)

    def drive(self):
        self.rate.sleep()
        start = self.get_clock().now()
        command = Twist()
        command.linear.x = 0.5
        while self.get_clock().now() - start < Duration(seconds=5):
            # A turn that grows slowly: every command counts, and so does the moment at which it comes.
            command.angular.z = 0.1 + 0.02 * (self.get_clock().now() - start).nanoseconds / 1e9
            self.publisher.publish(command)
            self.rate.sleep()
        self.publisher.publish(Twist())


def main():
    rclpy.init()
    node = Teleop()
    threading.Thread(target=node.drive, daemon=True).start()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
