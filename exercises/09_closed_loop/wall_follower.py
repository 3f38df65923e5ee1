"""Follow a wall at the distance, on the side and within the speed limit that ROS parameters say."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class WallFollower(Node):
    """Hears the lidar on /lidar/scan, and steers the robot with commands on /cmd_vel."""

    def __init__(self):
        super().__init__("wall_follower")
        # Your part: declare the parameters distance (0.6), side ("left") and speed_limit (0.5).
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, 10)

    def on_scan(self, scan):
        command = Twist()
        # Your part: find the nearest valid range on the side of the wall, compare it with the parameter distance, and
        # set command.linear.x and command.angular.z so that the difference becomes smaller.
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
