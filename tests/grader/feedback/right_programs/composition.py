"""A class that has a node and is none."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64


class Doubler:
    def __init__(self, node: Node) -> None:
        self._node = node
        self._pub = node.create_publisher(Float64, "twice", 10)
        node.create_subscription(Float64, "once", self, 10)

    def __call__(self, message: Float64) -> None:
        self._pub.publish(Float64(data=2.0 * message.data))


def main() -> None:
    rclpy.init()
    node = Node("doubler")
    doubler = Doubler(node)
    node.get_logger().info(f"{type(doubler).__name__} is ready")
    rclpy.spin(node)


if __name__ == "__main__":
    main()
