"""An action client in callbacks only."""

import rclpy
from action_tutorials_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class Customer(Node):
    def __init__(self):
        super().__init__("customer")
        self._client = ActionClient(self, Fibonacci, "fibonacci")

    def send(self, order: int) -> None:
        self._client.wait_for_server()
        future = self._client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=self._on_feedback)
        future.add_done_callback(self._on_answer)

    def _on_answer(self, future):
        handle = future.result()
        if not handle.accepted:
            self.get_logger().info("rejected")
            rclpy.shutdown()
            return
        handle.get_result_async().add_done_callback(self._on_result)

    def _on_feedback(self, message):
        self.get_logger().info(f"so far {list(message.feedback.partial_sequence)}")

    def _on_result(self, future):
        self.get_logger().info(f"all {list(future.result().result.sequence)}")
        rclpy.shutdown()


def main():
    rclpy.init()
    customer = Customer()
    customer.send(8)
    rclpy.spin(customer)


if __name__ == "__main__":
    main()
