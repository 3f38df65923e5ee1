"""A drive for five seconds as a state machine with an enum and match."""

from enum import Enum, auto

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Phase(Enum):
    WAITING = auto()
    DRIVING = auto()
    STOPPED = auto()


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.phase = Phase.WAITING
        self.began_ns = 0
        self.create_timer(0.05, self.step)

    def step(self):
        now_ns = self.get_clock().now().nanoseconds
        match self.phase:
            case Phase.WAITING:
                self.began_ns = now_ns
                self.phase = Phase.DRIVING
            case Phase.DRIVING if now_ns - self.began_ns >= 5 * 10**9:
                self.phase = Phase.STOPPED
            case _:
                pass
        twist = Twist()
        if self.phase is Phase.DRIVING:
            twist.linear.x = 0.5
            twist.angular.z = 0.1
        self.commands.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
