import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Once(Node):
    def __init__(self):
        super().__init__("once")
        self.publisher = self.create_publisher(String, "/greeting", 10)
        self.timer = self.create_timer(1.0, self.greet)

    def greet(self):
        self.publisher.publish(String(data="good night"))
        self.timer.cancel()


rclpy.init()
rclpy.spin(Once())
