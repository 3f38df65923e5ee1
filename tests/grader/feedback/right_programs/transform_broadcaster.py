"""Odometry as a transform."""

import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from tf2_ros import TransformBroadcaster


class Frames(Node):
    def __init__(self):
        super().__init__("frames")
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)

    def on_odometry(self, odometry):
        stamped = TransformStamped()
        stamped.header = odometry.header
        stamped.child_frame_id = odometry.child_frame_id
        position = odometry.pose.pose.position
        stamped.transform.translation.x = position.x
        stamped.transform.translation.y = position.y
        stamped.transform.translation.z = position.z
        stamped.transform.rotation = odometry.pose.pose.orientation
        self.broadcaster.sendTransform(stamped)


def main():
    rclpy.init()
    rclpy.spin(Frames())


if __name__ == "__main__":
    main()
