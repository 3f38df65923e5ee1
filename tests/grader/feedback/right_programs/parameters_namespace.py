"""Many parameters declared at once and read as properties."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Tuned(Node):
    def __init__(self):
        super().__init__("tuned")
        self.declare_parameters("", [("gain.linear", 0.5), ("gain.angular", 1.0), ("frame", "odom")])
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.2, self.work)

    @property
    def linear(self) -> float:
        return self.get_parameter("gain.linear").get_parameter_value().double_value

    @property
    def angular(self) -> float:
        return self.get_parameter("gain.angular").get_parameter_value().double_value

    def work(self):
        command = Twist()
        command.linear.x = 0.4 * self.linear
        command.angular.z = 0.2 * self.angular
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Tuned())


if __name__ == "__main__":
    main()
