"""A client that asks by a timer and takes the answer in a callback."""

import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger


class Periodic(Node):
    def __init__(self):
        super().__init__("periodic")
        self.client = self.create_client(Trigger, "/measure")
        self.pending = None
        self.create_timer(1.0, self.ask)

    def ask(self):
        if self.pending is not None or not self.client.service_is_ready():
            return
        self.pending = self.client.call_async(Trigger.Request())
        self.pending.add_done_callback(self.answered)

    def answered(self, future):
        self.pending = None
        error = future.exception()
        if error is not None:
            self.get_logger().warning(f"failed: {error}")
        else:
            self.get_logger().info(future.result().message)


def main():
    rclpy.init()
    rclpy.spin(Periodic())


if __name__ == "__main__":
    main()
