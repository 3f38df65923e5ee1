"""A right node for 03_teleop: one process plans, a second one, which it starts, limits the plan and drives."""

import subprocess
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node


class Planner(Node):
    def __init__(self):
        super().__init__("planner")
        self.publisher = self.create_publisher(Twist, "/plan", 10)
        self.timer = self.create_timer(0.1, self.plan)
        self.start = None

    def plan(self):
        if self.publisher.get_subscription_count() == 0:
            return
        now = self.get_clock().now()
        self.start = self.start or now
        command = Twist()
        if now - self.start < Duration(seconds=5):
            command.linear.x = 0.9
            command.angular.z = 0.1 + 0.02 * (now - self.start).nanoseconds / 1e9
        self.publisher.publish(command)


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Twist, "/plan", self.drive, 10)

    def drive(self, command):
        command.linear.x = min(command.linear.x, 0.5)
        self.publisher.publish(command)


def main():
    rclpy.init()
    if "driver" in sys.argv:
        rclpy.spin(Driver())
        return
    subprocess.Popen([sys.executable, __file__, "driver", "--ros-args", "-p", "use_sim_time:=true"])
    rclpy.spin(Planner())


if __name__ == "__main__":
    main()
