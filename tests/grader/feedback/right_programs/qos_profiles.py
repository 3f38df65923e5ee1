"""A latched map and best-effort sensor data."""

import rclpy
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
SENSOR = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


class Mapper(Node):
    def __init__(self):
        super().__init__("mapper")
        self.scans = 0
        self.map = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self.create_subscription(LaserScan, "/scan", self.count, SENSOR)
        self.create_timer(5.0, self.publish)

    def count(self, scan):
        self.scans += 1

    def publish(self):
        grid = OccupancyGrid()
        grid.header.stamp = self.get_clock().now().to_msg()
        grid.header.frame_id = "map"
        grid.info.resolution = 0.05
        grid.info.width, grid.info.height = 20, 10
        grid.info.origin.orientation.w = 1.0
        grid.data = [-1] * (grid.info.width * grid.info.height)
        self.map.publish(grid)


def main():
    rclpy.init()
    rclpy.spin(Mapper())


if __name__ == "__main__":
    main()
