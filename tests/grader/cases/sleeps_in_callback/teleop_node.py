"""Waits in each callback far longer than until the next, in C, where waiting takes no simulated time."""

import select

import rclpy
from geometry_msgs.msg import Twist


def tick():
    select.poll().poll(900)
    publisher.publish(Twist())


rclpy.init()
node = rclpy.create_node("sleeper")
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
node.create_timer(0.05, tick)
rclpy.spin(node)
