"""Bags: recordings of ROS topics, in the files and folders of rosbag2.

`storage/` reads and writes bags, without rclpy. `recording/` and `playing/` are the nodes behind `ros2 bag record` and
`ros2 bag play`.
"""
