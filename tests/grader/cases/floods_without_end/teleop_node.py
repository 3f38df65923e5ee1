import os
import threading
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.start = None

    def command(self):
        now = self.get_clock().now()
        self.start = self.start or now
        driving = (now - self.start).nanoseconds < 5_000_000_000
        twist = Twist()
        if driving:
            twist.linear.x, twist.angular.z = 0.5, 0.1
        return twist

    def tick(self):
        self.publisher.publish(self.command())


def flood():
    while True:
        os.write(1, b"x" * 1000 + b"\n")


def main():
    threading.Thread(target=flood, daemon=True).start()
    rclpy.init()
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
