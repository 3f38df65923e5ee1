"""Stop a robot whose commands stay away."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node

PATIENCE = Duration(seconds=0.5)


class Watchdog(Node):
    def __init__(self):
        super().__init__("watchdog")
        self.heard = self.get_clock().now()
        self.latest = Twist()
        self.out = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Twist, "/cmd_vel_raw", self.on_command, 10)
        self.create_timer(0.05, self.forward)

    def on_command(self, command):
        self.latest, self.heard = command, self.get_clock().now()

    def forward(self):
        late = self.get_clock().now() - self.heard > PATIENCE
        self.out.publish(Twist() if late else self.latest)


def main():
    rclpy.init()
    rclpy.spin(Watchdog())


if __name__ == "__main__":
    main()
