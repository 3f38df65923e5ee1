from rclpy.qos import qos_profile_sensor_data
from std_msgs.msg import Float32


def subscribe(node, on_message):
    return node.create_subscription(Float32, "/trial", on_message, qos_profile_sensor_data)
