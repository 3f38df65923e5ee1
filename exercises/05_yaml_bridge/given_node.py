"""Drives both robots of the yard and listens to all their sensors; without /clock its time stands still."""

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import Image, Imu, LaserScan


class Crew(Node):
    """Commands at 10 Hz of simulated time; every subscription asks for reliable delivery."""

    def __init__(self):
        super().__init__("crew")
        self.heard = {}
        self.scout = self.create_publisher(Twist, "/scout/cmd_vel", 10)
        self.robot = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_timer(0.1, self.drive)
        for topic, kind in {
            "/scout/odom": Odometry,
            "/scout/scan": LaserScan,
            "/scout/image": Image,
            "/scout/imu": Imu,
            "/odom": Odometry,
            "/camera/image_raw": Image,
            "/imu/data": Imu,
        }.items():
            self.create_subscription(kind, topic, lambda message, topic=topic: self.on_message(topic), 10)

    def drive(self):
        self.scout.publish(self.command(0.5, 0.2))
        self.robot.publish(self.command(0.3, -0.2))

    def command(self, ahead, left):
        command = Twist()
        command.linear.x = ahead
        command.angular.z = left
        return command

    def on_message(self, topic):
        self.heard[topic] = self.heard.get(topic, 0) + 1
        if self.heard[topic] == 1:
            self.get_logger().info(f"first message on {topic}")


def main():
    rclpy.init()
    rclpy.spin(Crew())


if __name__ == "__main__":
    main()
