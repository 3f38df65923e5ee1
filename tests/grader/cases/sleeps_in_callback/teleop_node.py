"""Does in each callback what takes far longer than the time until the next."""

import time

import rclpy
from geometry_msgs.msg import Twist


def tick():
    time.sleep(0.9)
    publisher.publish(Twist())


rclpy.init()
node = rclpy.create_node("sleeper")
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
node.create_timer(0.05, tick)
rclpy.spin(node)
