"""Publishes with the quality of service meant for sensors, which a reliable listener does not accept."""

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import String


class Hello(Node):
    """Publishes one std_msgs/msg/String on /hello."""

    def __init__(self):
        super().__init__("hello")
        self.publisher = self.create_publisher(String, "/hello", qos_profile_sensor_data)
        self.timer = self.create_timer(1.0, self.say_hello)

    def say_hello(self):
        self.publisher.publish(String(data="hello, robot"))
        self.timer.cancel()  # once is enough


def main():
    rclpy.init()
    rclpy.spin(Hello())


if __name__ == "__main__":
    main()
