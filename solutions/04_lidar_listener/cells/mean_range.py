import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class MeanRange(Node):
    def __init__(self):
        super().__init__("mean_range")
        self.result = self.create_publisher(Float32, "/mean_range", 10)
        self.subscription = self.create_subscription(LaserScan, "/lidar/scan", self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        valid = [r for r in scan.ranges if scan.range_min < r < scan.range_max]
        self.result.publish(Float32(data=sum(valid) / len(valid)))


rclpy.init()
rclpy.spin(MeanRange())
