"""A node in a context manager."""

from contextlib import contextmanager

import rclpy
from std_msgs.msg import String


@contextmanager
def running_node(name):
    rclpy.init()
    node = rclpy.create_node(name)
    try:
        yield node
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def main():
    with running_node("managed") as node:
        out = node.create_publisher(String, "talk", 10)
        node.create_timer(1.0, lambda: out.publish(String(data="still here")))
        rclpy.spin(node)


if __name__ == "__main__":
    main()
