"""One node sees, one node drives; exact stamps, the hue in a BGR picture, threads."""

from math import atan2, cos, hypot, pi, remainder, sin

import numpy as np
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped, Twist
from message_filters import Subscriber, TimeSynchronizer
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, Imu
from std_msgs.msg import Int32


class Eyes(Node):
    """Publishes a point for each red post in each pair of pictures."""

    def __init__(self):
        super().__init__("eyes")
        self.points = self.create_publisher(PointStamped, "/red_post", 50)
        self.inputs = [
            Subscriber(self, CameraInfo, "/camera/camera_info"),
            Subscriber(self, Image, "/camera/image", qos_profile=qos_profile_sensor_data),
            Subscriber(self, Image, "/depth/image", qos_profile=qos_profile_sensor_data),
        ]
        self.together = TimeSynchronizer(self.inputs, 20)
        self.together.registerCallback(self.look)

    def look(self, info, image, depth):
        blue, green, red = np.moveaxis(CvBridge().imgmsg_to_cv2(image, "bgr8").astype(np.float32), 2, 0)
        is_red = (red > 1.8 * np.maximum(green, blue)) & (red > 30)
        distance = CvBridge().imgmsg_to_cv2(depth)
        full = np.flatnonzero(is_red.sum(axis=0) > 3)
        for columns in np.split(full, np.flatnonzero(np.diff(full) > 1) + 1):
            if len(columns) < 2:
                continue
            pixels = is_red[:, columns]
            ahead = float(np.mean(distance[:, columns][pixels]))
            slope = (info.k[2] - float(columns.mean())) / info.k[0]
            point = PointStamped(header=image.header)
            point.point.x, point.point.y = ahead, ahead * slope
            self.points.publish(point)


class Legs(Node):
    """Turns, counts, and drives to the nearest post."""

    def __init__(self):
        super().__init__("legs")
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.counts = self.create_publisher(Int32, "/red_count", 10)
        self.create_subscription(Imu, "/imu", self.on_imu, 100)
        self.create_subscription(PointStamped, "/red_post", self.on_point, 50)
        self.create_timer(0.04, self.drive)
        self.turning_rates, self.last, self.heading = [], 0.0, 0.0
        self.clusters, self.counted, self.latest = [], False, None

    def on_imu(self, message):
        now = message.header.stamp.sec + message.header.stamp.nanosec / 1e9
        if now < 1.0:
            self.turning_rates.append(message.angular_velocity.z)
        else:
            bias = sum(self.turning_rates) / len(self.turning_rates)
            self.heading += (message.angular_velocity.z - bias) * (now - self.last)
        self.last = now

    def on_point(self, message):
        ahead, left = message.point.x, message.point.y
        self.latest = (ahead, left)
        if self.counted:
            return
        x = (ahead + 0.12) * cos(self.heading) - left * sin(self.heading)
        y = (ahead + 0.12) * sin(self.heading) + left * cos(self.heading)
        for cluster in self.clusters:
            if hypot(cluster[0][0] - x, cluster[0][1] - y) < 0.4:
                cluster.append((x, y))
                return
        self.clusters.append([(x, y)])

    def drive(self):
        command = Twist()
        if self.last < 1.0:
            return
        if not self.counted and self.heading < 2 * pi - 0.05:
            command.angular.z = 0.7
        elif not self.counted:
            self.counted = True
            self.counts.publish(Int32(data=len(self.clusters)))
            places = [np.mean(cluster, axis=0) for cluster in self.clusters]
            self.nearest = min(places, key=lambda place: hypot(*place))
        else:
            off = remainder(atan2(self.nearest[1], self.nearest[0]) - self.heading, 2 * pi)
            if abs(off) > 0.25:
                command.angular.z = 0.7 if off > 0 else -0.7
                self.latest = None
            elif self.latest:
                command.angular.z = atan2(self.latest[1], self.latest[0])
                command.linear.x = max(-0.2, min(0.3, 0.9 * (self.latest[0] - 1.02)))
            else:
                command.angular.z = 0.2 if off > 0 else -0.2
        self.commands.publish(command)


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(2)
    for node in (Eyes(), Legs()):
        executor.add_node(node)
    executor.spin()


main()
