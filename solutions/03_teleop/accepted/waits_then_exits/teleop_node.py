"""Two commands are enough: the robot keeps the last one. The node follows odometry's stamps and exits when done."""

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop")
        self.done = Future()
        self.started = None
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)

    def on_odometry(self, message):
        now = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        if self.started is None:
            self.started = now
            command = Twist()
            command.linear.x = 0.5
            command.angular.z = 0.08
            self.publisher.publish(command)
        elif now - self.started >= 5.0 and not self.done.done():
            self.publisher.publish(Twist())
            self.done.set_result(True)


def main():
    rclpy.init()
    node = Teleop()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    executor.spin_until_future_complete(node.done)
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
