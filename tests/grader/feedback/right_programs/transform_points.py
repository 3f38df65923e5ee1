"""Points of a sensor in another frame, kept until their transform is there."""

from collections import deque

import rclpy
import tf2_geometry_msgs
import tf2_ros
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.time import Time

OLDEST = 2.0  # [s]


class Points(Node):
    def __init__(self):
        super().__init__("points")
        self.frames = tf2_ros.Buffer()
        self.ear = tf2_ros.TransformListener(self.frames, self)
        self.out = self.create_publisher(PointStamped, "/points_in_odom", 10)
        self.kept = deque(maxlen=50)
        self.create_subscription(PointStamped, "/points", self.on_point, 10)

    def on_point(self, point):
        self.kept.append(point)
        still = deque(maxlen=50)
        for each in self.kept:
            when = Time.from_msg(each.header.stamp)
            try:
                transform = self.frames.lookup_transform("odom", each.header.frame_id, when)
            except tf2_ros.TransformException:
                if (self.get_clock().now() - when).nanoseconds < OLDEST * 1e9:
                    still.append(each)
                continue
            self.out.publish(tf2_geometry_msgs.do_transform_point(each, transform))
        self.kept = still


def main():
    rclpy.init()
    rclpy.spin(Points())


if __name__ == "__main__":
    main()
