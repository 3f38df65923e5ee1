"""A loop of one's own around spin_once."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


def main():
    rclpy.init()
    node = Node("looper")
    latest = []
    node.create_subscription(LaserScan, "/scan", latest.append, 1)
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
            while latest:
                scan = latest.pop(0)
                node.get_logger().info(f"{len(scan.ranges)} rays")
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
