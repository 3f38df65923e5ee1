"""A node whose speed changes while it runs, with a callback that checks it."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


class Adjustable(Node):
    def __init__(self):
        super().__init__("adjustable")
        described = ParameterDescriptor(
            description="speed ahead", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.0)]
        )
        self._speed = self.declare_parameter("speed", 0.3, described).value
        self.add_on_set_parameters_callback(self._check)
        self._pub = self.create_publisher(Twist, "cmd_vel", 10)
        self._timer = self.create_timer(0.1, self._send)

    def _check(self, changes: list[Parameter]) -> SetParametersResult:
        for change in changes:
            if change.name == "speed":
                if change.type_ != Parameter.Type.DOUBLE or change.value < 0.0:
                    return SetParametersResult(successful=False, reason="speed is a number from 0 on")
                self._speed = change.value
        return SetParametersResult(successful=True)

    def _send(self):
        message = Twist()
        message.linear.x = self._speed
        self._pub.publish(message)


def main():
    rclpy.init()
    rclpy.spin(Adjustable())


if __name__ == "__main__":
    main()
