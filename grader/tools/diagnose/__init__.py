"""The implementation of `course diagnose`: finds errors in the live ROS and Gazebo graphs and explains them.

`live.py` is the overview: observe both sides, ask every file in `looks/`, worst finding first.
"""
