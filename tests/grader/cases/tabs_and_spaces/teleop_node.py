import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


def main():
        rclpy.init()
	rclpy.spin(None)
