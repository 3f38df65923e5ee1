"""Waits for each transform in a coroutine, which keeps nobody from running."""

from math import cos, sin

import rclpy
import tf2_geometry_msgs  # noqa: F401  registers PointStamped with Buffer.transform
from geometry_msgs.msg import PointStamped
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformListener


class Asynchronous(Node):
    def __init__(self):
        super().__init__("asynchronous")
        self.buffer = Buffer(node=self)
        self.listener = TransformListener(self.buffer, self)
        self.result = self.create_publisher(PointStamped, "nearest_hit", 1)
        self.create_subscription(
            LaserScan, "scan", self.on_scan, qos_profile_sensor_data, callback_group=ReentrantCallbackGroup()
        )

    async def on_scan(self, scan):
        await self.buffer.wait_for_transform_async("odom", scan.header.frame_id, Time.from_msg(scan.header.stamp))
        ray = min(range(len(scan.ranges)), key=lambda i: scan.ranges[i])
        hit = PointStamped(header=scan.header)
        hit.point.x = scan.ranges[ray] * cos(scan.angle_min + ray * scan.angle_increment)
        hit.point.y = scan.ranges[ray] * sin(scan.angle_min + ray * scan.angle_increment)
        self.result.publish(self.buffer.transform(hit, "odom"))


rclpy.init()
rclpy.spin(Asynchronous())
