import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Bool


class Planner(Node):
    def __init__(self):
        super().__init__("planner")
        self.publisher = self.create_publisher(Bool, "/drive", 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.start = None

    def tick(self):
        now = self.get_clock().now()
        self.start = self.start or now
        self.publisher.publish(Bool(data=(now - self.start).nanoseconds < 5_000_000_000))


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.subscription = self.create_subscription(Bool, "/drive", self.drive, 10)

    def drive(self, message):
        twist = Twist()
        if message.data:
            twist.linear.x, twist.angular.z = 0.5, 0.1
        self.publisher.publish(twist)


def main():
    rclpy.init()
    executor = SingleThreadedExecutor()
    executor.add_node(Planner())
    executor.add_node(Driver())
    executor.spin()


if __name__ == "__main__":
    main()
