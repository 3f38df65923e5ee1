import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Teleop(Node)
    pass
