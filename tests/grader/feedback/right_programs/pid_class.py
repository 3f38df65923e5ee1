"""Keep a distance to a wall ahead with a PID controller in a class of its own."""

import math
from dataclasses import dataclass, field

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan


@dataclass
class Pid:
    p: float
    i: float
    d: float
    most: float
    total: float = 0.0
    previous: float | None = field(default=None)

    def output(self, error: float, seconds: float) -> float:
        change = 0.0 if self.previous is None or seconds <= 0.0 else (error - self.previous) / seconds
        self.previous = error
        self.total = max(-1.0, min(1.0, self.total + error * seconds))
        wanted = self.p * error + self.i * self.total + self.d * change
        return max(-self.most, min(self.most, wanted))


class Keeper(Node):
    def __init__(self) -> None:
        super().__init__("keeper")
        self.pid = Pid(0.8, 0.05, 0.1, 0.4)
        self.stamp: Time | None = None
        self.out = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        stamp = Time.from_msg(scan.header.stamp)
        seconds = 0.0 if self.stamp is None else (stamp - self.stamp).nanoseconds * 1e-9
        self.stamp = stamp
        ahead = [
            distance
            for index, distance in enumerate(scan.ranges)
            if abs(scan.angle_min + index * scan.angle_increment) < math.radians(10)
            and scan.range_min < distance < scan.range_max
        ]
        command = Twist()
        if ahead:
            command.linear.x = self.pid.output(min(ahead) - 1.0, seconds)
        self.out.publish(command)


def main() -> None:
    rclpy.init()
    rclpy.spin(Keeper())


if __name__ == "__main__":
    main()
