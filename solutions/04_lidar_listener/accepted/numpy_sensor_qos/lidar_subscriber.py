"""The same with numpy and functions, and with the QoS profile meant for sensors."""

import numpy as np
import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


def main():
    rclpy.init()
    node = rclpy.create_node("lidar_numpy")
    publisher = node.create_publisher(Float32, "nearest_obstacle", 1)

    def on_scan(scan):
        ranges = np.asarray(scan.ranges)
        valid = ranges[(ranges >= scan.range_min) & (ranges <= scan.range_max)]
        if valid.size:
            node.get_logger().info(f"Scan: {valid.size} valid rays, min={valid.min():.3f}m, avg={valid.mean():.3f}m")
            publisher.publish(Float32(data=float(valid.min())))

    node.create_subscription(LaserScan, "lidar/scan", on_scan, qos_profile_sensor_data)
    rclpy.spin(node)


main()
