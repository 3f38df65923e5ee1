"""Functions instead of a class: one timer repeats the command, a second one ends it."""

import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node("teleop_two_timers")
    publisher = node.create_publisher(Twist, "cmd_vel", 1)
    drive = Twist()
    drive.linear.x, drive.angular.z = 0.5, 0.15

    repeat = node.create_timer(0.05, lambda: publisher.publish(drive))

    def stop():
        repeat.cancel()
        finish.cancel()
        publisher.publish(Twist())
        node.get_logger().info("arrived")

    finish = node.create_timer(5.05, stop)
    rclpy.spin(node)


main()
