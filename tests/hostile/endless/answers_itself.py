# Two processes whose nodes answer each other at once: simulated time never goes on.
import os
import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import Int64


def main():
    second = os.environ.get("SECOND") == "1"
    if not second:
        import subprocess

        subprocess.Popen([sys.executable, __file__], env=os.environ | {"SECOND": "1"})
    rclpy.init()
    node = Node("pong" if second else "ping")
    publisher = node.create_publisher(Int64, "/ping" if second else "/pong", 10)
    node.create_subscription(
        Int64, "/pong" if second else "/ping", lambda said: publisher.publish(Int64(data=said.data + 1)), 10
    )
    if not second:
        node.create_timer(1.0, lambda: publisher.publish(Int64()))
    rclpy.spin(node)


main()
