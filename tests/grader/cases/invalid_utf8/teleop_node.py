import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

# café
rclpy.init()
