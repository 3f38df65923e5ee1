"""Measures the distance from base_link to the wall ahead: takes /scan, publishes wall."""

import contextlib
import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan, Range
from tf2_ros import Buffer, TransformException, TransformListener

FRAME = "base_link"
HALF_WIDTH = 0.15  # [m] of the cart: what is farther to the side is not in its way
OLDEST = 0.5  # [s] of a scan that is used


class Ranger(Node):
    """Publishes the distance of the nearest point ahead, in the frame base_link."""

    def __init__(self):
        super().__init__("ranger")
        self.frames = Buffer()
        self.listener = TransformListener(self.frames, self)
        self.publisher = self.create_publisher(Range, "wall", 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)

    def on_scan(self, scan):
        age = (self.get_clock().now() - Time.from_msg(scan.header.stamp)).nanoseconds / 1e9
        if abs(age) > OLDEST:
            self.get_logger().warning(f"a scan is {age:.1f} s old: ignored", once=True)
            return
        try:
            mount = self.frames.lookup_transform(FRAME, scan.header.frame_id, Time()).transform
        except TransformException as error:
            self.get_logger().warning(f"no frame for the scan: {error}", once=True)
            return
        q = mount.rotation
        yaw = 2 * math.atan2(q.z, q.w)
        ahead = []
        for number, distance in enumerate(scan.ranges):
            if scan.range_min <= distance <= scan.range_max:
                angle = yaw + scan.angle_min + number * scan.angle_increment
                x = mount.translation.x + distance * math.cos(angle)
                y = mount.translation.y + distance * math.sin(angle)
                if x > 0 and abs(y) < HALF_WIDTH:
                    ahead.append(x)
        if ahead:
            wall = Range(radiation_type=Range.INFRARED, min_range=0.0, max_range=scan.range_max, range=min(ahead))
            wall.header.stamp, wall.header.frame_id = scan.header.stamp, FRAME
            self.publisher.publish(wall)


def main():
    rclpy.init()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Ranger())


if __name__ == "__main__":
    main()
