"""A right node for 03_teleop: spins from an asyncio loop, beside a task that reports."""

import asyncio

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node


class Teleop(Node):
    def __init__(self):
        super().__init__("teleop_asyncio")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.publish_command)
        self.start = None

    def publish_command(self):
        now = self.get_clock().now()
        self.start = self.start or now
        command = Twist()
        if now - self.start < Duration(seconds=5):
            command.linear.x = 0.5
            command.angular.z = 0.1 + 0.02 * (now - self.start).nanoseconds / 1e9
        self.publisher.publish(command)


async def spin(node):
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.005)


async def report(node):
    while rclpy.ok():
        await asyncio.sleep(1)
        node.get_logger().info("still here")


async def run(node):
    await asyncio.gather(spin(node), report(node))


def main():
    rclpy.init()
    asyncio.run(run(Teleop()))


if __name__ == "__main__":
    main()
