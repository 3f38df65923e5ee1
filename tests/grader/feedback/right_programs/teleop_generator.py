# The plan is a generator; every tick asks it for the next command.
import rclpy
from geometry_msgs.msg import Twist


def plan(clock):
    start = clock.now().nanoseconds
    go, stop = Twist(), Twist()
    go.linear.x, go.angular.z = 0.5, 0.1
    while clock.now().nanoseconds - start < 5_000_000_000:
        yield go
    while True:
        yield stop


rclpy.init()
node = rclpy.create_node("teleop")
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
commands = plan(node.get_clock())
node.create_timer(1 / 20, lambda: publisher.publish(next(commands)))
while rclpy.ok():
    rclpy.spin_once(node, timeout_sec=0.1)
