"""Takes tenths of a second for seconds: the timer fires long before the second is over."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Hello(Node):
    """Publishes one std_msgs/msg/String on /hello."""

    def __init__(self):
        super().__init__("hello")
        self.publisher = self.create_publisher(String, "/hello", 10)
        self.timer = self.create_timer(0.2, self.say_hello)

    def say_hello(self):
        self.publisher.publish(String(data="hello, robot"))
        self.timer.cancel()  # once is enough


def main():
    rclpy.init()
    rclpy.spin(Hello())


if __name__ == "__main__":
    main()
