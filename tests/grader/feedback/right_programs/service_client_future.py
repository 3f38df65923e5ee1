"""A client that waits for its answer outside of callbacks."""

import sys

import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger


class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self.client = self.create_client(Trigger, "/reset")

    def ask(self, patience: float = 5.0) -> bool:
        if not self.client.wait_for_service(timeout_sec=patience):
            self.get_logger().error("no service")
            return False
        future = self.client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(self, future, timeout_sec=patience)
        return future.done() and future.result().success


def main() -> int:
    rclpy.init()
    node = Asker()
    try:
        return 0 if node.ask() else 1
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    sys.exit(main())
