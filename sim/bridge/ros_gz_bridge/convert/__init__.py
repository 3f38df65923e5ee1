"""Conversions, one file or folder for each ROS message package, with its name; `type_pairs` finds them here.

The type pairs and the corresponding fields are those of ros_gz_bridge. The meaning and the unit of a field are
documented in the `.msg` and `.srv` files of the ROS package and in the `.proto` files of gz-msgs.

Source: README.md and src/convert/*.cpp of ros_gz_bridge, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_bridge
"""
