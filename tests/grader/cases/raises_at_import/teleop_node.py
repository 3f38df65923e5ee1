import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

SPEED = {"slow": 0.1}["fast"]
