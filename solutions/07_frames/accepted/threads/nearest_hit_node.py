"""Waits for each transform in one of several threads, while another one hears it."""

from math import cos, sin

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_geometry_msgs import do_transform_point
from tf2_ros import Buffer, TransformException, TransformListener


class Threads(Node):
    def __init__(self):
        super().__init__("threads")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.result = self.create_publisher(PointStamped, "/nearest_hit", 10)
        group = ReentrantCallbackGroup()
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10, callback_group=group)

    def on_scan(self, scan):
        when = Time.from_msg(scan.header.stamp)
        try:
            to_odom = self.buffer.lookup_transform("odom", scan.header.frame_id, when, timeout=Duration(seconds=0.2))
        except TransformException as error:
            self.get_logger().warning(f"no transform: {error}")
            return
        angle, nearest = scan.angle_min, None
        for distance in scan.ranges:
            if scan.range_min <= distance <= scan.range_max and (nearest is None or distance < nearest[0]):
                nearest = distance, angle
            angle += scan.angle_increment
        if nearest is None:
            return
        point = PointStamped()
        point.point.x, point.point.y = nearest[0] * cos(nearest[1]), nearest[0] * sin(nearest[1])
        point = do_transform_point(point, to_odom)
        point.header.frame_id = "odom"
        point.header.stamp = scan.header.stamp
        self.result.publish(point)


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(3)
    executor.add_node(Threads())
    executor.spin()


main()
