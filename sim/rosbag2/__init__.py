"""Bags: recordings of ROS topics, in the files and folders of rosbag2.

`bag.py` reads a bag and `bag_writer.py` writes one; neither needs rclpy. `recorder.py` and `player.py` are the nodes
behind `ros2 bag record` and `ros2 bag play`.
"""
