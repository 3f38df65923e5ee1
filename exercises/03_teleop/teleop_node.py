"""Drive the robot forward with a slight left turn for five seconds, then stop it."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Teleop(Node):
    """Publishes velocity commands on /cmd_vel."""

    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish_command)
        self.start = None

    def publish_command(self):
        now = self.get_clock().now()
        if self.start is None:
            self.start = now
        command = Twist()
        # Your part: while fewer than five seconds have passed since self.start, command.linear.x is 0.5 m/s and
        # command.angular.z a small positive number; afterwards both are zero.
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
