"""A node that is spun by asyncio."""

import asyncio

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


async def spin(node: Node) -> None:
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.01)


async def talk(node: Node) -> None:
    publisher = node.create_publisher(String, "news", 10)
    for number in range(1_000_000):
        publisher.publish(String(data=f"news {number}"))
        await asyncio.sleep(0.5)


async def work() -> None:
    node = Node("asynchronous")
    await asyncio.gather(spin(node), talk(node))


def main() -> None:
    rclpy.init()
    asyncio.run(work())


if __name__ == "__main__":
    main()
