"""Drive forward for some seconds; whatever ends the node, the robot gets a last command of zeros."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node

LONG_ENOUGH = Duration(seconds=5.0)


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.wheels = self.create_publisher(Twist, "/cmd_vel", 10)
        self.began = None
        self.create_timer(0.1, self.command)

    def command(self):
        now = self.get_clock().now()
        if self.began is None:
            self.began = now
        order = Twist()
        if now - self.began < LONG_ENOUGH:
            order.linear.x = 0.5
            order.angular.z = 0.1
        self.wheels.publish(order)


def main():
    rclpy.init()
    node = Driver()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info("stopping")
        node.wheels.publish(Twist())
    finally:
        node.wheels.publish(Twist())
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
