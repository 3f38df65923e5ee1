"""Sends the text in a Header, believing that any type with a text in it will do."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Header


class Hello(Node):
    """Publishes one std_msgs/msg/Header on /hello."""

    def __init__(self):
        super().__init__("hello")
        self.publisher = self.create_publisher(Header, "/hello", 10)
        self.timer = self.create_timer(1.0, self.say_hello)

    def say_hello(self):
        self.publisher.publish(Header(frame_id="hello, robot"))
        self.timer.cancel()  # once is enough


def main():
    rclpy.init()
    rclpy.spin(Hello())


if __name__ == "__main__":
    main()
