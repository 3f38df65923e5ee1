"""Publishes before anybody has found the node, and is gone."""

import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("hello")
publisher = node.create_publisher(String, "/hello", 10)
publisher.publish(String(data="hello, robot"))
node.destroy_node()
rclpy.shutdown()
