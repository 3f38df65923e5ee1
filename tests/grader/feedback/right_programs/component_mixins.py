"""A node of mixins."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool, Float64


class Speaks:
    def open_output(self):
        self.output = self.create_publisher(Float64, "output", 10)

    def say(self, number):
        self.output.publish(Float64(data=float(number)))


class Listens:
    def open_input(self):
        self.active = True
        self.create_subscription(Bool, "active", self.on_active, 10)

    def on_active(self, message):
        self.active = message.data


class Worker(Speaks, Listens, Node):
    def __init__(self):
        Node.__init__(self, "worker")
        self.open_output()
        self.open_input()
        self.create_timer(0.2, self.work)

    def work(self):
        if self.active:
            self.say(self.get_clock().now().nanoseconds / 1e9)


def main():
    rclpy.init()
    rclpy.spin(Worker())


if __name__ == "__main__":
    main()
