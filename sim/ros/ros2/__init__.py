"""The `ros2` command for machines without a ROS 2 installation; an installed one takes precedence.

Source: https://github.com/ros2/ros2cli
"""
