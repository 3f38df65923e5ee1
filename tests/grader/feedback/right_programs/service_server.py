"""A service that switches a node on and off."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool


class Switch(Node):
    def __init__(self):
        super().__init__("switch")
        self.enabled = False
        self.state = self.create_publisher(Bool, "state", 10)
        self.create_service(SetBool, "enable", self.on_enable)
        self.create_timer(1.0, lambda: self.state.publish(Bool(data=self.enabled)))

    def on_enable(self, request, response):
        changed, self.enabled = self.enabled != request.data, request.data
        response.success = True
        response.message = "changed" if changed else "as before"
        return response


def main():
    rclpy.init()
    rclpy.spin(Switch())


if __name__ == "__main__":
    main()
