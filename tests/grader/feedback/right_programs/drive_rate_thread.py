"""A drive in a thread of its own, beside a spinning executor."""

import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Mover(Node):
    def __init__(self):
        super().__init__("mover")
        self.out = self.create_publisher(Twist, "/cmd_vel", 10)

    def run(self):
        rate = self.create_rate(10)
        start = self.get_clock().now()
        while rclpy.ok():
            twist = Twist()
            if (self.get_clock().now() - start).nanoseconds * 1e-9 < 5.0:
                twist.linear.x = 0.5
                twist.angular.z = 0.1
            self.out.publish(twist)
            rate.sleep()


def main():
    rclpy.init()
    mover = Mover()
    executor = MultiThreadedExecutor()
    executor.add_node(mover)
    worker = threading.Thread(target=mover.run, daemon=True)
    worker.start()
    executor.spin()


if __name__ == "__main__":
    main()
