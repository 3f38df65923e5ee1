"""No timer: the robot's odometry tells the time, and a future tells when all is done."""

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String


class Hello(Node):
    def __init__(self):
        super().__init__("hello_odometry")
        self.done = Future()
        self.hello = self.create_publisher(String, "/hello", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10)

    def on_odometry(self, odometry):
        stamp = odometry.header.stamp
        if stamp.sec >= 1 and not self.done.done():
            self.hello.publish(String(data="hello, robot"))
            self.done.set_result(stamp)


def main():
    rclpy.init()
    node = Hello()
    rclpy.spin_until_future_complete(node, node.done)
    rclpy.spin(node)


main()
