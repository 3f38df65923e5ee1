"""The place of the robot in a frame, asked for by a timer."""

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener


class Where(Node):
    def __init__(self):
        super().__init__("where")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.out = self.create_publisher(PointStamped, "place", 10)
        self.create_timer(0.5, self.look)

    def look(self):
        try:
            found = self.buffer.lookup_transform("odom", "base_link", Time())
        except TransformException as error:
            self.get_logger().info(f"not yet: {error}", throttle_duration_sec=5.0)
            return
        place = PointStamped(header=found.header)
        place.point.x = found.transform.translation.x
        place.point.y = found.transform.translation.y
        self.out.publish(place)


def main():
    rclpy.init()
    rclpy.spin(Where())


if __name__ == "__main__":
    main()
