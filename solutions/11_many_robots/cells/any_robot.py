import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float64


class Gap(Node):
    """Publishes how far ahead the robot in front is [m]; it began 1.2 m ahead."""

    def __init__(self):
        super().__init__("gap")
        self.own = self.front = None
        self.publisher = self.create_publisher(Float64, "gap", 10)
        self.create_subscription(Odometry, "odom", self.on_own, 10)
        self.create_subscription(Odometry, "front/odom", self.on_front, 10)
        print("ready", flush=True)

    def on_own(self, message):
        self.own = message.pose.pose.position.x

    def on_front(self, message):
        self.front = message.pose.pose.position.x
        if self.own is not None:
            self.publisher.publish(Float64(data=self.front + 1.2 - self.own))


rclpy.init()
try:
    rclpy.spin(Gap())
except KeyboardInterrupt:
    pass
