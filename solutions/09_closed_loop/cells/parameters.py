import rclpy
from rclpy.node import Node


class WallFollower(Node):
    def __init__(self):
        super().__init__("wall_follower")
        self.declare_parameter("distance", 0.6)
        self.declare_parameter("side", "left")
        self.declare_parameter("speed_limit", 0.5)
        print("ready", flush=True)


rclpy.init()
rclpy.spin(WallFollower())
