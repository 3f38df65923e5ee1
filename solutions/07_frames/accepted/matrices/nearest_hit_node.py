"""Functions and NumPy: a timer tries the scans that wait, and the two transforms are multiplied by hand."""

import numpy as np
import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformListener


def matrix(transform):
    """Return the 4 x 4 matrix of a transform."""
    t, q = transform.translation, transform.rotation
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), t.x],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), t.y],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), t.z],
            [0, 0, 0, 1],
        ]
    )


rclpy.init()
node = rclpy.create_node("matrices")
buffer = Buffer()
listener = TransformListener(buffer, node)
result = node.create_publisher(PointStamped, "/nearest_hit", 10)
waiting = []


def try_again():
    for scan in list(waiting):
        when = Time.from_msg(scan.header.stamp)
        if buffer.can_transform("odom", "robot", when) and buffer.can_transform("robot", scan.header.frame_id, when):
            waiting.remove(scan)
            answer(scan, when)


def answer(scan, when):
    robot = buffer.lookup_transform("odom", "robot", when)
    mount = buffer.lookup_transform("robot", scan.header.frame_id, when)
    ranges = np.array(scan.ranges)
    ranges[(ranges < scan.range_min) | (ranges > scan.range_max)] = np.inf
    ray = int(np.argmin(ranges))
    angle = scan.angle_min + ray * scan.angle_increment
    hit = ranges[ray] * np.array([np.cos(angle), np.sin(angle), 0, 0]) + np.array([0, 0, 0, 1])
    there = matrix(robot.transform) @ matrix(mount.transform) @ hit
    message = PointStamped(header=robot.header)
    message.header.stamp = scan.header.stamp
    message.point.x, message.point.y, message.point.z = (float(v) for v in there[:3])
    result.publish(message)


node.create_subscription(LaserScan, "/scan", waiting.append, 10)
node.create_timer(0.02, try_again)
rclpy.spin(node)
