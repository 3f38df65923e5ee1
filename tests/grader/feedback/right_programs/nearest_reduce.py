"""A search by hand in a function that knows no ROS."""

import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64


def smallest(ranges, low, high):
    best = float("inf")
    for value in ranges:
        if low < value < high and value < best:
            best = value
    return best


rclpy.init()
node = rclpy.create_node("smallest_range")
publisher = node.create_publisher(Float64, "/nearest", 10)


def heard(scan):
    found = smallest(scan.ranges, scan.range_min, scan.range_max)
    if found != float("inf"):
        publisher.publish(Float64(data=found))


subscription = node.create_subscription(LaserScan, "/lidar/scan", heard, qos_profile_sensor_data)
rclpy.spin(node)
