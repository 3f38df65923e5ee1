import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64


class Free(Node):
    """Publishes the distance [m] to what is nearest in the scan."""

    def __init__(self):
        super().__init__("free")
        self.publisher = self.create_publisher(Float64, "/free", 10)
        qos = QoSProfile(depth=10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, qos)
        print("ready", flush=True)

    def on_scan(self, scan):
        valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        self.publisher.publish(Float64(data=min(valid, default=scan.range_max)))


rclpy.init()
try:
    rclpy.spin(Free())
except (KeyboardInterrupt, ExternalShutdownException):
    pass
