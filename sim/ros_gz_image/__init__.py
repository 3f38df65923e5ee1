"""Brings Gazebo's images to ROS, in place of the ``ros_gz_image`` package: the executable ``image_bridge``."""
