"""Stop at a wall and go on when it is far enough again."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

STOP, GO = 0.5, 0.8  # [m]


class Careful(Node):
    def __init__(self):
        super().__init__("careful")
        self.stopped = False
        self.out = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)

    def on_scan(self, scan):
        seen = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        nearest = min(seen, default=scan.range_max)
        if nearest < STOP:
            self.stopped = True
        elif nearest > GO:
            self.stopped = False
        command = Twist()
        command.linear.x = 0.0 if self.stopped else 0.3
        self.out.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Careful())


if __name__ == "__main__":
    main()
