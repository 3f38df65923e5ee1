"""Python access to sensor messages, in place of the `sensor_msgs_py` package of ROS 2.

Source: sensor_msgs_py of common_interfaces 5.3 (Jazzy), https://github.com/ros2/common_interfaces/tree/jazzy
"""
