"""Turn once on the spot, find the red posts, then stop one metre before the nearest one."""

from math import atan2, hypot, pi, remainder

import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped, Twist
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Imu
from std_msgs.msg import Int32

STANDING = 1.0  # [s] at the start, in which the robot stands still


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
        # Your part, 1: subscribe to /camera/image and /depth/image, so that on_pictures gets pairs of one stamp.
        self.timer = self.create_timer(0.1, self.drive)
        self.heading = None  # [rad] since the start, positive to the left; None while the robot stands still
        self.focal_length = self.middle = None  # [pixels]
        self.seen = []  # the red posts in the last pictures: (ahead, left) of the camera [m]
        self.posts = []  # all that were found: (x, y) [m] from where the robot stands, x as it looked at the start
        self.target = None

    def on_imu(self, message):
        # Your part, 2: while the robot stands still, measure the bias of message.angular_velocity.z.
        # After STANDING seconds self.heading is 0.0, and then the sum of what the robot has turned.
        pass

    def on_camera_info(self, message):
        self.focal_length, self.middle = message.k[0], message.k[2]

    def on_pictures(self, image, depth):
        self.seen = []
        # Your part, 3: append (ahead, left) [m] of each red post in the picture to self.seen.
        for ahead, left in self.seen:
            # Your part, 4: publish a PointStamped.
            if self.target is None:
                self.remember(ahead, left)

    def remember(self, ahead, left):
        # Your part, 5: add the post to self.posts, unless it is there already. The camera is 0.12 m ahead of the
        # robot's middle.
        pass

    def drive(self):
        """Turn once, publish the number of posts, face the nearest, drive until it is 1 m away. Given."""
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
