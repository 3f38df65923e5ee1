"""Turn once on the spot, find the red posts, then stop one metre before the nearest one."""

from math import atan2, cos, hypot, pi, remainder, sin

import message_filters
import numpy as np
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped, Twist
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image, Imu
from std_msgs.msg import Int32

STANDING = 1.0  # [s] at the start, in which the robot stands still
SAME_POST = 0.5  # [rad] directions that differ by less than this are of the same post


class RedPosts(Node):
    """Hears the gyroscope and the two cameras."""

    def __init__(self):
        super().__init__("red_posts")
        self.bridge = CvBridge()
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.points = self.create_publisher(PointStamped, "/red_post", 10)
        self.counts = self.create_publisher(Int32, "/red_count", 10)
        self.create_subscription(Imu, "/imu", self.on_imu, 100)
        self.create_subscription(CameraInfo, "/camera/camera_info", self.on_camera_info, 10)
        pictures = [
            message_filters.Subscriber(self, Image, topic, qos_profile=qos_profile_sensor_data)
            for topic in ("/camera/image", "/depth/image")
        ]
        self.pairs = message_filters.ApproximateTimeSynchronizer(pictures, queue_size=10, slop=0.05)
        self.pairs.registerCallback(self.on_pictures)
        self.timer = self.create_timer(0.1, self.drive)
        self.heading = None  # [rad] since the start, positive to the left; None while the robot stands still
        self.rates = []  # [rad/s] what the gyroscope says while the robot stands still
        self.start = self.last = None  # times of the first and of the last message of the gyroscope
        self.focal_length = self.middle = None  # [pixels]
        self.seen = []  # the red posts in the last pictures: (ahead, left) of the camera [m]
        self.posts = []  # all that were found: (x, y) [m] from where the robot stands, x as it looked at the start
        self.target = None

    def on_imu(self, message):
        now = Time.from_msg(message.header.stamp)
        self.start = self.start or now
        if (now - self.start).nanoseconds < STANDING * 1e9:
            self.rates.append(message.angular_velocity.z)
        elif self.heading is None:
            self.heading = 0.0
        else:
            passed = (now - self.last).nanoseconds / 1e9
            self.heading += (message.angular_velocity.z - np.mean(self.rates)) * passed
        self.last = now

    def on_camera_info(self, message):
        self.focal_length, self.middle = message.k[0], message.k[2]

    def on_pictures(self, image, depth):
        if self.focal_length is None:
            return
        distances = self.bridge.imgmsg_to_cv2(depth, "32FC1")
        colours = self.bridge.imgmsg_to_cv2(image, "rgb8").astype(int)
        self.seen = []
        for column, pixels in self.red_things(colours):
            ahead = float(np.median(distances[pixels]))
            if np.isfinite(ahead):
                self.seen.append((ahead, -(column - self.middle) / self.focal_length * ahead))
        for ahead, left in self.seen:
            point = PointStamped()
            point.header.stamp = image.header.stamp
            point.header.frame_id = "camera_link"
            point.point.x, point.point.y = ahead, left
            self.points.publish(point)
            if self.target is None:
                self.remember(ahead, left)

    def red_things(self, colours):
        """Return the middle column and the pixels, shape (height, width), of each red thing in a picture."""
        red, green, blue = colours[:, :, 0], colours[:, :, 1], colours[:, :, 2]
        is_red = (red > 50) & (red > 2 * green) & (red > 2 * blue)
        columns = np.arange(is_red.shape[1])
        edges = np.flatnonzero(np.diff(is_red.sum(axis=0) >= 5, prepend=False, append=False))
        for first, after in edges.reshape(-1, 2):
            yield (first + after - 1) / 2, is_red & (columns >= first) & (columns < after)

    def remember(self, ahead, left):
        """Add a post to those that were found, unless it is one of them."""
        heading, ahead = self.heading or 0.0, ahead + 0.12  # the camera is 0.12 m ahead of the robot's middle
        x = ahead * cos(heading) - left * sin(heading)
        y = ahead * sin(heading) + left * cos(heading)
        direction = atan2(y, x)
        if any(abs(remainder(direction - atan2(b, a), 2 * pi)) < SAME_POST for a, b in self.posts):
            return
        self.posts.append((x, y))

    def drive(self):
        """Turn once, publish the number of posts, face the nearest, drive until it is 1 m away."""
        if self.heading is None:
            return
        command = Twist()
        if self.target is None and self.heading < 2 * pi - 0.02:
            command.angular.z = min(0.8, 0.1 + 2 * (2 * pi - self.heading))
        elif self.target is None:
            self.counts.publish(Int32(data=len(self.posts)))
            self.target = min(self.posts, key=lambda post: hypot(*post), default=(0.0, 0.0))
        elif self.posts:
            error = remainder(atan2(self.target[1], self.target[0]) - self.heading, 2 * pi)
            if self.seen and abs(error) < 0.3:
                ahead, left = min(self.seen, key=lambda post: abs(atan2(post[1], post[0]) - error))
                command.angular.z = atan2(left, ahead)
                command.linear.x = max(-0.1, min(0.3, ahead - 1.0))
            else:
                command.angular.z = max(-0.8, min(0.8, 2 * error))
        self.commands.publish(command)


def main():
    rclpy.init()
    rclpy.spin(RedPosts())


if __name__ == "__main__":
    main()
