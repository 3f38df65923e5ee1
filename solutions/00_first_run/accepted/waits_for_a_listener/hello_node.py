"""Looks ten times a second: when a second has passed and somebody listens it speaks, and then it is done."""

import rclpy
from rclpy.duration import Duration
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node("hello_listener")
    publisher = node.create_publisher(String, "/hello", 10)
    started = None
    node.create_timer(0.1, lambda: None)  # wakes the loop below
    while rclpy.ok():
        rclpy.spin_once(node)
        now = node.get_clock().now()
        started = started or now
        if now - started >= Duration(seconds=1) and publisher.get_subscription_count() > 0:
            break
    publisher.publish(String(data="hello, robot"))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
