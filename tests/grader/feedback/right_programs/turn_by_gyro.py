"""Add up a gyroscope's rates between stamps, with the bias of the first second taken off."""

import rclpy
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import Imu
from std_msgs.msg import Float64

STILL = 100  # messages


class Turned(Node):
    def __init__(self):
        super().__init__("turned")
        self.still = []
        self.bias = 0.0
        self.before = None
        self.angle = 0.0
        self.out = self.create_publisher(Float64, "/turned", 10)
        self.create_subscription(Imu, "/imu", self.on_imu, 50)

    def on_imu(self, imu):
        stamp = Time.from_msg(imu.header.stamp)
        rate = imu.angular_velocity.z
        if len(self.still) < STILL:
            self.still.append(rate)
            self.bias = sum(self.still) / len(self.still)
        elif self.before is not None:
            seconds = (stamp - self.before).nanoseconds / 1e9
            self.angle += (rate - self.bias) * seconds
            self.out.publish(Float64(data=self.angle))
        self.before = stamp


def main():
    rclpy.init()
    rclpy.spin(Turned())


if __name__ == "__main__":
    main()
