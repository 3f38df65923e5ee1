"""One scan, and then the end."""

import rclpy
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from sensor_msgs.msg import LaserScan


def main():
    rclpy.init()
    node = Node("once")
    found, scan = wait_for_message(LaserScan, node, "/scan", time_to_wait=5.0)
    if found:
        print(min(r for r in scan.ranges if scan.range_min < r < scan.range_max))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
