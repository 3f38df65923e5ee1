"""A drive as a generator of commands that a timer asks."""

import rclpy
from geometry_msgs.msg import Twist


def commands(clock):
    begin = clock.now()
    while (clock.now() - begin).nanoseconds < 5_000_000_000:
        drive = Twist()
        drive.linear.x, drive.angular.z = 0.5, 0.1
        yield drive
    while True:
        yield Twist()


def main():
    rclpy.init()
    node = rclpy.create_node("teleop")
    out = node.create_publisher(Twist, "/cmd_vel", 10)
    ahead = None

    def tick():
        nonlocal ahead
        if ahead is None:
            ahead = commands(node.get_clock())
        out.publish(next(ahead))

    node.create_timer(0.1, tick)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
