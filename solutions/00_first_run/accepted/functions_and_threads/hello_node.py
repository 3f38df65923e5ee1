"""Functions instead of a class, and an executor with two threads."""

import rclpy
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node("hello_functions")
    publisher = node.create_publisher(String, "hello", 1)

    def say_hello():
        timer.cancel()
        greeting = String()
        greeting.data = "hello, robot"
        publisher.publish(greeting)
        node.get_logger().info("said hello")

    timer = node.create_timer(1.0, say_hello)
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    executor.spin()


main()
