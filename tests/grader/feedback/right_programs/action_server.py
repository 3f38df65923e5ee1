"""An action server that counts, with feedback, cancellation and one goal at a time."""

import threading

import rclpy
from action_tutorials_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        self._lock = threading.Lock()
        self._busy = False
        self._server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self._execute,
            goal_callback=self._on_goal,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def _on_goal(self, request):
        with self._lock:
            if self._busy or request.order < 0:
                return GoalResponse.REJECT
            self._busy = True
        return GoalResponse.ACCEPT

    def _execute(self, handle):
        rate = self.create_rate(10)
        numbers = [0, 1]
        try:
            for _ in range(handle.request.order):
                if handle.is_cancel_requested:
                    handle.canceled()
                    return Fibonacci.Result(sequence=numbers)
                numbers.append(numbers[-1] + numbers[-2])
                handle.publish_feedback(Fibonacci.Feedback(partial_sequence=numbers))
                rate.sleep()
            handle.succeed()
            return Fibonacci.Result(sequence=numbers)
        finally:
            with self._lock:
                self._busy = False


def main():
    rclpy.init()
    executor = MultiThreadedExecutor()
    executor.add_node(Counter())
    executor.spin()


if __name__ == "__main__":
    main()
