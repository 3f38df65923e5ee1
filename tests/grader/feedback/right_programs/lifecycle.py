"""A node with a life cycle."""

from contextlib import suppress

import rclpy
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_msgs.msg import String


class Talker(LifecycleNode):
    def __init__(self) -> None:
        super().__init__("lifecycle_talker")
        self.count = 0
        self.out = None
        self.timer = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.out = self.create_lifecycle_publisher(String, "chatter", 10)
        self.timer = self.create_timer(1.0, self.talk)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.destroy_timer(self.timer)
        self.destroy_publisher(self.out)
        self.timer = self.out = None
        return TransitionCallbackReturn.SUCCESS

    def talk(self) -> None:
        if self.out is not None and self.out.is_activated:
            self.count += 1
            self.out.publish(String(data=f"life {self.count}"))


def main() -> None:
    rclpy.init()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(Talker())
    with suppress(KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
