"""The middle of what is red in a picture."""

import numpy as np
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from sensor_msgs.msg import Image


class Red(Node):
    def __init__(self):
        super().__init__("red")
        self.bridge = CvBridge()
        self.out = self.create_publisher(PointStamped, "/red", 10)
        self.create_subscription(Image, "/camera", self.on_image, 10)

    def on_image(self, image):
        pixels = self.bridge.imgmsg_to_cv2(image, desired_encoding="rgb8").astype(np.int32)
        red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
        rows, columns = np.nonzero((red > 100) & (red > 2 * green) & (red > 2 * blue))
        if len(columns) == 0:
            return
        found = PointStamped(header=image.header)
        found.point.x = float(columns.mean())
        found.point.y = float(rows.mean())
        self.out.publish(found)


def main():
    rclpy.init()
    rclpy.spin(Red())


if __name__ == "__main__":
    main()
