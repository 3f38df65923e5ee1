"""Two processes: one says how fast, the other drives."""
import subprocess
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Float64


def planner():
    rclpy.init()
    node = Node("planner")
    out = node.create_publisher(Float64, "/speed", 10)
    start = None

    def tick():
        nonlocal start
        now = node.get_clock().now().nanoseconds / 1e9
        start = now if start is None else start
        out.publish(Float64(data=0.5 if now - start < 5.0 else 0.0))

    node.create_timer(0.1, tick)
    rclpy.spin(node)


def driver():
    rclpy.init()
    node = Node("driver")
    out = node.create_publisher(Twist, "/cmd_vel", 10)

    def hear(message):
        twist = Twist()
        twist.linear.x = message.data
        twist.angular.z = 0.1 if message.data else 0.0
        out.publish(twist)

    node.create_subscription(Float64, "/speed", hear, 10)
    rclpy.spin(node)


if "planner" in sys.argv:
    planner()
else:
    child = subprocess.Popen([sys.executable, __file__, "planner", "--ros-args", "-p", "use_sim_time:=true"])
    try:
        driver()
    finally:
        child.terminate()
        child.wait()
