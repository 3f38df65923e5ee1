"""Two nodes in one executor, one of which talks to the other."""

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32


class Source(Node):
    def __init__(self):
        super().__init__("source")
        self.value = 0
        self.out = self.create_publisher(Int32, "numbers", 10)
        self.create_timer(0.1, self.emit)

    def emit(self):
        self.out.publish(Int32(data=self.value))
        self.value += 1


class Sink(Node):
    def __init__(self):
        super().__init__("sink")
        self.total = 0
        self.create_subscription(Int32, "numbers", self.add, 10)

    def add(self, message):
        self.total += message.data
        self.get_logger().debug(f"total {self.total}")


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    nodes = [Source(), Sink()]
    for node in nodes:
        executor.add_node(node)
    try:
        executor.spin()
    finally:
        for node in nodes:
            executor.remove_node(node)
            node.destroy_node()


if __name__ == "__main__":
    main()
