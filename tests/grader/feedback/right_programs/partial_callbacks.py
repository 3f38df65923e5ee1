"""One callback for several robots by functools.partial."""

from functools import partial

import rclpy
from geometry_msgs.msg import Point
from nav_msgs.msg import Odometry
from rclpy.node import Node

ROBOTS = ("front", "middle", "rear")


class Fleet(Node):
    def __init__(self):
        super().__init__("fleet")
        self.places: dict[str, Point] = {}
        for name in ROBOTS:
            self.create_subscription(Odometry, f"/{name}/odom", partial(self.on_odometry, name), 10)
        self.create_timer(1.0, self.report)

    def on_odometry(self, name, odometry):
        self.places[name] = odometry.pose.pose.position

    def report(self):
        for name, place in sorted(self.places.items()):
            self.get_logger().info(f"{name}: {place.x:.2f} {place.y:.2f}")


def main():
    rclpy.init()
    rclpy.spin(Fleet())


if __name__ == "__main__":
    main()
