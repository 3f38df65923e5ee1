"""The room behind `course diagnose`: looks at the live ROS and Gazebo graphs and says what cannot work, and why.

`live.py` shows it on one screen: observe both sides, ask every file in `looks/`, worst finding first.
"""
