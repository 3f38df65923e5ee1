"""A service that awaits another one, in a reentrant group."""

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger


class Relay(Node):
    def __init__(self):
        super().__init__("relay")
        group = ReentrantCallbackGroup()
        self.inner = self.create_client(Trigger, "inner", callback_group=group)
        self.outer = self.create_service(Trigger, "outer", self.serve, callback_group=group)

    async def serve(self, request, response):
        answer = await self.inner.call_async(request)
        response.success = answer.success
        response.message = f"relayed: {answer.message}"
        return response


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(num_threads=2)
    node = Relay()
    executor.add_node(node)
    try:
        executor.spin()
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
