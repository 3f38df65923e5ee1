"""rqt_graph's place: nodes and topics of ROS, bridges and Gazebo's side as one picture.

Source: https://github.com/ros-visualization/rqt_graph
"""
